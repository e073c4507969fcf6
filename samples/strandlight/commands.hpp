// The subcommands, one source file each. They read options, call the public API and print.
#pragma once

#include "samples/strandlight/options.hpp"

namespace strandlight::cli {

Command addInfo(CLI::App& parent);
Command addBake(CLI::App& parent);
Command addRender(CLI::App& parent);
Command addReference(CLI::App& parent);
Command addCompare(CLI::App& parent);
Command addFits(CLI::App& parent);
Command addReport(CLI::App& parent);
Command addNnCheck(CLI::App& parent);
Command addHair(CLI::App& parent);
Command addHairTrain(CLI::App& hair); // called by addHair
Command addBench(CLI::App& parent);
Command addStress(CLI::App& parent);

} // namespace strandlight::cli
