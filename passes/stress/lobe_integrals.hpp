// The second half of the group "lobes".
#pragma once

#include <vector>

#include "passes/stress/stress.hpp"

namespace strandlight {

void stressLobeIntegrals(Context& context, const StressSettings& settings,
                         std::vector<StressRow>& rows);

} // namespace strandlight
