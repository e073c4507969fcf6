// One main for every test program. Warnings of ours are failures of the test that caused them.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>

#include "engine/base/progress.hpp"

int main(int argc, char** argv)
{
    // Hazards across submits are only found when asked for (Khronos validation 1.3.239).
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
           0);
    strandlight::Progress::setEnabled(false);
    doctest::Context context(argc, argv);
    return context.run();
}
