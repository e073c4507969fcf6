// Where files lie that a later run can do without.
#pragma once

#include <filesystem>

namespace strandlight {

// $XDG_CACHE_HOME/strandlight, else $HOME/.cache/strandlight; empty without either. Need not exist.
std::filesystem::path cacheFolder();

} // namespace strandlight
