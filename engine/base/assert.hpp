// Programmer errors. Always on: a wrong picture costs more than a compare.
#pragma once

#include <sstream>
#include <string>

namespace strandlight {
[[noreturn]] void failAssertion(const char* file, int line, const std::string& text);
}

#define STRANDLIGHT_ASSERT(condition)                                                              \
    do {                                                                                           \
        if (!(condition))                                                                          \
            ::strandlight::failAssertion(__FILE__, __LINE__, #condition);                          \
    } while (false)

#define STRANDLIGHT_ASSERT_EQ(a, b)                                                                \
    do {                                                                                           \
        if (!((a) == (b))) {                                                                       \
            std::ostringstream text;                                                               \
            text << #a " == " #b " (" << (a) << " and " << (b) << ")";                             \
            ::strandlight::failAssertion(__FILE__, __LINE__, text.str());                          \
        }                                                                                          \
    } while (false)
