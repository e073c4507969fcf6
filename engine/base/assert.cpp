#include "engine/base/assert.hpp"

#include <cstdio>
#include <cstdlib>

namespace strandlight {

void failAssertion(const char* file, int line, const std::string& text)
{
    std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, text.c_str());
    std::abort();
}

} // namespace strandlight
