#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "asset_reply.hpp"
#include "kith/service/server_options.hpp"
#include "reply.hpp"
#include "request.hpp"
#include "site.hpp"

namespace kith {

/// What a request is for.
struct Destination {
  enum class Kind { kAsset, kApplication, kWebSocket };
  Kind kind = Kind::kAsset;
  const Asset* asset = nullptr;  ///< For kAsset.
  std::string target{};          ///< Path and query.
};

/// Judges requests by their heads alone: an answer that refuses it, or where it goes. Knows no sockets.
class RequestRules {
 public:
  explicit RequestRules(const ServerOptions& options);

  /// @return the refusal, or nothing and `destination`.
  [[nodiscard]] std::optional<ServerReply> judge(const HttpMessage& head, bool has_body,
                                                 Destination& destination) const;
  /// Whether a complete request below /api may reach the application.
  [[nodiscard]] std::optional<ServerReply> judge_body(const HttpMessage& request) const;

 private:
  [[nodiscard]] std::optional<ServerReply> judge_message(const HttpMessage& head) const;
  [[nodiscard]] std::optional<ServerReply> judge_host(const HttpMessage& head, std::string& target) const;
  [[nodiscard]] std::optional<ServerReply> judge_upgrade(const HttpMessage& head, bool has_body) const;
  [[nodiscard]] bool is_from_our_page(const HttpMessage& head) const;

  ServerLimits limits_;
  Site site_;
  AssetIndex assets_;
};

}  // namespace kith
