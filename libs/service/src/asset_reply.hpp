#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "kith/service/asset.hpp"
#include "reply.hpp"
#include "request.hpp"

namespace kith {

/// Finds the embedded file of a path, and answers requests for it. Everything there is, is in this table: no path leads
/// anywhere else.
class AssetIndex {
 public:
  AssetIndex(std::span<const Asset> assets, const std::map<std::string, std::string>& pages);
  /// The file at `path`, without a query, or null.
  [[nodiscard]] const Asset* find(std::string_view path) const;

 private:
  std::unordered_map<std::string, const Asset*> by_path_;
};

/// The whole file, its compressed copy, or 304 if the client has it already.
[[nodiscard]] ServerReply asset_reply(const Asset& asset, const HttpMessage& request);

/// Whether an Accept-Encoding field allows gzip.
[[nodiscard]] bool accepts_gzip(std::string_view accept_encoding);

}  // namespace kith
