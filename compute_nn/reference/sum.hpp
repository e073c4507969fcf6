// Plain CPU twin of the sum: in order, compensated.
// Kahan. Further Remarks on Reducing Truncation Errors. 1965
#pragma once

#include <span>

namespace strandlight::reference {

template <class T> T sum(std::span<const T> values)
{
    T total = T(0), lost = T(0);
    for (const T value : values) {
        const T term = value - lost;
        const T next = total + term;
        lost = (next - total) - term;
        total = next;
    }
    return total;
}

} // namespace strandlight::reference
