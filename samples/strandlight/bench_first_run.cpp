// What the first run on a machine costs: all kernels of a bake and of a hair frame compiled, in
// processes of their own with empty caches; then the same processes again, with what the first have
// left.
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/base/error.hpp"
#include "samples/strandlight/bench_kernels.hpp"

namespace strandlight::cli {

namespace fs = std::filesystem;

namespace {

// Removed with all that is in it.
class TemporaryFolder
{
public:
    TemporaryFolder() : path_(fs::temp_directory_path() / "strandlight_bench_XXXXXX")
    {
        std::string name = path_.string();
        if (::mkdtemp(name.data()) == nullptr)
            throw Error("bench: cannot make a temporary folder " + path_.string());
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

// This program with other arguments and its caches in `caches`; wall milliseconds. Throws Error
// when it fails.
double runSelf(std::vector<std::string> arguments, const fs::path& caches)
{
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = ::fork();
    if (child == 0) {
        ::setenv("XDG_CACHE_HOME", caches.c_str(), 1);
        ::setenv("MESA_SHADER_CACHE_DIR", caches.c_str(), 1);
        const int sink = ::open("/dev/null", O_WRONLY);
        ::dup2(sink, STDOUT_FILENO);
        ::dup2(sink, STDERR_FILENO);
        std::vector<char*> argv = {const_cast<char*>("strandlight")};
        for (std::string& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        ::execv("/proc/self/exe", argv.data());
        ::_exit(127);
    }
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0)
        throw Error("bench: `strandlight " + arguments[0] + "` failed in a process of its own");
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start;
    return elapsed.count();
}

// The smallest work that runs every kernel: what remains is starting up and compiling.
KernelMeasurement measureFirstRun(Context&, const BenchOptions& o, Ceilings&)
{
    const TemporaryFolder folder;
    const fs::path caches = folder.path() / "caches";
    fs::create_directory(caches);
    const std::string bake = (folder.path() / "a.sgl").string();
    std::vector<std::vector<std::string>> commands = {
        {"bake", "builtin:box", "-o", bake, "--atlas", "8", "--lightfield", "4", "--spp", "1",
         "--steps", "1"},
        {"hair", "render", "builtin:short", "-o", (folder.path() / "a.png").string(), "--size",
         "64x64"}};
    if (!o.device.device.empty())
        for (std::vector<std::string>& command : commands)
            command.insert(command.end(), {"--device", o.device.device});
    double bakeMs[2], hairMs[2]; // cold, warm
    for (int warm = 0; warm < 2; ++warm) {
        bakeMs[warm] = runSelf(commands[0], caches);
        hairMs[warm] = runSelf(commands[1], caches);
    }
    KernelMeasurement m; // no outputs to check: the commands have tests of their own
    m.timing = timingOf({bakeMs[0] + hairMs[0]});
    m.more = {{"cold_bake_ms", bakeMs[0]},
              {"cold_hair_ms", hairMs[0]},
              {"warm_ms", bakeMs[1] + hairMs[1]}};
    return m;
}

} // namespace

void addFirstRunBenchCases(std::vector<KernelCase>& cases)
{
    cases.push_back({"first run: bake and hair frame, empty caches", measureFirstRun});
}

} // namespace strandlight::cli
