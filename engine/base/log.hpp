// Four levels to stderr; stdout belongs to results. Tests turn warnings into failures by a sink.
#pragma once

#include <functional>
#include <string>

namespace strandlight {

enum class LogLevel
{
    Debug,
    Info,
    Warning,
    Error
};

using LogSink = std::function<void(LogLevel, const std::string&)>;

void setLogLevel(LogLevel lowest);
LogSink setLogSink(LogSink sink); // returns the previous one
void logDebug(const std::string& text);
void logInfo(const std::string& text);
void logWarning(const std::string& text);
void logError(const std::string& text);

} // namespace strandlight
