#include "tests/command/run_command.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "tests/support/gltf_maker.hpp"

namespace strandlight::test {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr char kProgram[] = STRANDLIGHT_BINARY_DIR "/bin/strandlight";
constexpr milliseconds kLimit{120000};

std::string text(const std::filesystem::path& path)
{
    const std::vector<std::uint8_t> bytes = fileBytes(path);
    return {bytes.begin(), bytes.end()};
}

// In the child: streams into files, extra environment, then the program. Does not return.
[[noreturn]] void become(const std::vector<std::string>& arguments, const CommandOptions& options,
                         const std::filesystem::path& folder)
{
    const auto redirect = [](const std::string& path, int flags, int stream) {
        const int file = ::open(path.c_str(), flags, 0644);
        ::dup2(file, stream);
    };
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect((folder / "out").string(), O_WRONLY | O_CREAT, STDOUT_FILENO);
    redirect((folder / "err").string(), O_WRONLY | O_CREAT, STDERR_FILENO);
    for (const std::string& variable : options.environment) {
        const std::size_t equals = variable.find('=');
        ::setenv(variable.substr(0, equals).c_str(), variable.c_str() + equals + 1, 1);
    }
    std::vector<char*> argv{const_cast<char*>(kProgram)};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execv(kProgram, argv.data());
    ::_exit(127);
}

int waitFor(pid_t child, int interruptAfter)
{
    const Clock::time_point start = Clock::now();
    bool interrupted = interruptAfter < 0;
    int status = 0;
    while (::waitpid(child, &status, WNOHANG) == 0) {
        const auto elapsed = Clock::now() - start;
        if (!interrupted && elapsed >= milliseconds(interruptAfter)) {
            ::kill(child, SIGINT);
            interrupted = true;
        }
        if (elapsed > kLimit) {
            ::kill(child, SIGKILL);
            ::waitpid(child, &status, 0);
            break;
        }
        std::this_thread::sleep_for(milliseconds(2));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

} // namespace

CommandResult runCommand(const std::vector<std::string>& arguments, const CommandOptions& options)
{
    const TemporaryFolder streams;
    const pid_t child = ::fork();
    if (child == 0)
        become(arguments, options, streams.path());
    CommandResult result;
    result.exitCode = waitFor(child, options.interruptAfterMilliseconds);
    result.output = text(streams.path() / "out");
    result.errors = text(streams.path() / "err");
    return result;
}

std::vector<std::uint8_t> fileBytes(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

nlohmann::json readJson(const std::filesystem::path& path)
{
    return nlohmann::json::parse(text(path));
}

std::vector<std::string> listFolder(const std::filesystem::path& folder)
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

void checkFails(const CommandResult& result, const std::string& part)
{
    CAPTURE(part);
    CAPTURE(result.errors);
    CHECK(result.exitCode == 1);
    CHECK(result.output.empty());
    CHECK(result.errors.starts_with("error: "));
    CHECK(result.errors.find(part) != std::string::npos);
    CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
}

} // namespace strandlight::test
