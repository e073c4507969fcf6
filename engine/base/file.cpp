#include "engine/base/file.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <unistd.h>

#include "engine/base/error.hpp"

namespace strandlight {

namespace fs = std::filesystem;

std::vector<std::uint8_t> readFile(const fs::path& path, std::uint64_t maximumBytes)
{
    std::error_code error;
    if (fs::is_directory(path, error))
        throw FileError(path.string(), "", "is a folder, not a file");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (!file)
        throw FileError(path.string(), "", std::string("cannot open: ") + std::strerror(errno));
    const std::uint64_t size = fs::file_size(path, error);
    if (error)
        throw FileError(path.string(), "", "cannot read its size: " + error.message());
    if (size > maximumBytes)
        throw FileError(path.string(), "",
                        "has " + std::to_string(size) + " bytes, more than the limit of " +
                            std::to_string(maximumBytes));
    std::vector<std::uint8_t> bytes(size);
    const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), file.get());
    if (got != bytes.size())
        throw FileError(path.string(), "byte " + std::to_string(got), "cannot read further");
    return bytes;
}

namespace {

void writeAll(int descriptor, std::span<const std::uint8_t> bytes, const std::string& name)
{
    while (!bytes.empty()) {
        const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            throw FileError(name, "", std::string("cannot write: ") + std::strerror(errno));
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

} // namespace

void writeFileAtomically(const fs::path& path, std::span<const std::uint8_t> bytes)
{
    const fs::path temporary = path.string() + ".tmp." + std::to_string(::getpid());
    const int descriptor =
        ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0)
        throw FileError(path.string(), "", std::string("cannot create: ") + std::strerror(errno));
    try {
        writeAll(descriptor, bytes, path.string());
        if (::fsync(descriptor) != 0)
            throw FileError(path.string(), "",
                            std::string("cannot flush: ") + std::strerror(errno));
    } catch (...) {
        ::close(descriptor);
        ::unlink(temporary.c_str());
        throw;
    }
    ::close(descriptor);
    if (std::rename(temporary.c_str(), path.c_str()) != 0) {
        const std::string reason = std::strerror(errno);
        ::unlink(temporary.c_str());
        throw FileError(path.string(), "", "cannot rename the finished file into place: " + reason);
    }
}

void writeFileAtomically(const fs::path& path, std::string_view text)
{
    writeFileAtomically(path,
                        std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void removeStaleTemporaries(const fs::path& path)
{
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const std::string prefix = path.filename().string() + ".tmp.";
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(prefix))
            continue;
        const int pid = std::atoi(name.c_str() + prefix.size());
        const bool alive = pid > 0 && (::kill(pid, 0) == 0 || errno == EPERM);
        if (!alive)
            fs::remove(entry.path(), error);
    }
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t seed)
{
    static const std::array<std::uint32_t, 256> table = [] {
        std::array<std::uint32_t, 256> t{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            std::uint32_t c = i;
            for (int k = 0; k < 8; ++k)
                c = (c & 1u) ? 0xEDB88320u ^ (c >> 1) : c >> 1;
            t[i] = c;
        }
        return t;
    }();
    std::uint32_t c = ~seed;
    for (const std::uint8_t b : bytes)
        c = table[(c ^ b) & 0xFFu] ^ (c >> 8);
    return ~c;
}

} // namespace strandlight
