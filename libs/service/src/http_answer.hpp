#pragma once

#include <functional>
#include <string>

#include "kith/explain/json.hpp"
#include "kith/service/live_service.hpp"

namespace kith {

// Takes the answer to a request, once.
using HttpAnswer = LiveService::HttpAnswer;

[[nodiscard]] LiveService::HttpReply json_reply(int status, const Json& body);
[[nodiscard]] LiveService::HttpReply error_reply(int status, const std::string& reason, const std::string& text);

}  // namespace kith
