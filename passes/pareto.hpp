// Which of many measured choices are worth having.
#pragma once

#include <span>
#include <vector>

namespace strandlight {

// [i] true: no other choice costs at most as much with at most the error and is better in one of
// the two. Equal choices are both on the front; a choice with a value that is not finite never is.
// cost, error [n], smaller is better.
std::vector<bool> paretoFront(std::span<const double> cost, std::span<const double> error);

} // namespace strandlight
