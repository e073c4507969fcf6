// Three classes of error, after Falcor's policy: our own mistakes assert (assert.hpp); input,
// files, Vulkan and misuse of the API throw one of these, with the values in the text; expected
// outcomes are return values. Only main and tests catch.
#pragma once

#include <stdexcept>
#include <string>

namespace strandlight {

class Error : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

// A file the user gave: path, place inside it (offset, line, "mesh 3, primitive 0") and the reason.
class FileError : public Error
{
public:
    FileError(const std::string& path, const std::string& place, const std::string& reason)
        : Error(place.empty() ? path + ": " + reason : path + ": " + place + ": " + reason)
    {
    }
};

class GraphError : public Error
{
public:
    using Error::Error;
};

class VulkanError : public Error
{
public:
    using Error::Error;
};

// The user asked to stop (SIGINT). Work done so far is on disk.
class Interrupted : public Error
{
public:
    Interrupted() : Error("interrupted") {}
};

} // namespace strandlight
