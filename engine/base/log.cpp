#include "engine/base/log.hpp"

#include <cstdio>
#include <mutex>
#include <utility>

namespace strandlight {

namespace {

void writeToStderr(LogLevel level, const std::string& text)
{
    static const char* const kNames[] = {"debug", "info", "warning", "error"};
    std::fprintf(stderr, "%s: %s\n", kNames[static_cast<int>(level)], text.c_str());
}

struct Logger
{
    std::mutex mutex;
    LogLevel lowest = LogLevel::Info;
    LogSink sink = writeToStderr;
};

Logger& logger()
{
    static Logger instance; // the one piece of process-wide state: where text goes
    return instance;
}

void log(LogLevel level, const std::string& text)
{
    std::lock_guard lock(logger().mutex);
    if (level >= logger().lowest)
        logger().sink(level, text);
}

} // namespace

void setLogLevel(LogLevel lowest)
{
    std::lock_guard lock(logger().mutex);
    logger().lowest = lowest;
}

LogSink setLogSink(LogSink sink)
{
    std::lock_guard lock(logger().mutex);
    return std::exchange(logger().sink, sink ? std::move(sink) : LogSink(writeToStderr));
}

void logDebug(const std::string& text)
{
    log(LogLevel::Debug, text);
}
void logInfo(const std::string& text)
{
    log(LogLevel::Info, text);
}
void logWarning(const std::string& text)
{
    log(LogLevel::Warning, text);
}
void logError(const std::string& text)
{
    log(LogLevel::Error, text);
}

} // namespace strandlight
