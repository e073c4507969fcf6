// Where the shared test vectors are; they are not part of the repository.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/gpu_fixture.hpp"

namespace strandlight::test {

inline std::filesystem::path vectorFolder()
{
    return std::filesystem::path(dataFolder()) / "vectors";
}

// Files whose name starts with `prefix`, sorted; empty when the data is not there.
inline std::vector<std::filesystem::path> vectorFiles(const std::string& prefix = "")
{
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(vectorFolder(), error))
        if (entry.path().extension() == ".safetensors" &&
            entry.path().filename().string().starts_with(prefix))
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace strandlight::test
