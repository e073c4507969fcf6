// The built command as a user runs it: a process with arguments, streams and an exit code.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace strandlight::test {

struct CommandResult
{
    int exitCode = -1; // 128 + signal when a signal ended it
    std::string output;
    std::string errors;
};

struct CommandOptions
{
    std::vector<std::string> environment; // "NAME=value", added
    int interruptAfterMilliseconds = -1;  // SIGINT; negative: never
};

// Runs build/bin/strandlight with the device of the tests' choice. Ends it after two minutes.
CommandResult runCommand(const std::vector<std::string>& arguments,
                         const CommandOptions& options = {});

std::vector<std::uint8_t> fileBytes(const std::filesystem::path& path); // empty when missing
nlohmann::json readJson(const std::filesystem::path& path); // throws when it is not JSON

// Names in a folder, sorted.
std::vector<std::string> listFolder(const std::filesystem::path& folder);

// The contract of failure: exit code 1, nothing on stdout, one line "error: ..." on stderr that
// holds `part`.
void checkFails(const CommandResult& result, const std::string& part);

} // namespace strandlight::test
