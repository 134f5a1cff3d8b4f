#include "asset_reply.hpp"

#include <cctype>
#include <stdexcept>
#include <vector>

namespace kith {
namespace {

namespace http = boost::beast::http;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(at);
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string lowered(std::string_view text) {
  std::string result;
  for (const char c : text) result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

// "gzip;q=0" and "gzip; q=0.000" refuse what they name.
bool has_no_weight(const std::vector<std::string_view>& parameters) {
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    const auto text = lowered(parameters[i]);
    if (text.rfind("q=0", 0) == 0 && text.find_first_not_of("0.", 2) == std::string::npos) return true;
  }
  return false;
}

// The client's copies, as weak or strong tags; "*" is any. (RFC 9110, 13.1.2: compared weakly.)
bool names_tag(std::string_view if_none_match, std::string_view tag) {
  for (auto one : split(if_none_match, ',')) {
    if (one == "*") return true;
    if (one.substr(0, 2) == "W/") one.remove_prefix(2);
    if (one == tag) return true;
  }
  return false;
}

}  // namespace

AssetIndex::AssetIndex(std::span<const Asset> assets, const std::map<std::string, std::string>& pages) {
  for (const auto& asset : assets) by_path_.emplace(asset.path, &asset);
  for (const auto& [path, name] : pages) {
    const auto found = by_path_.find(name);
    if (found == by_path_.end()) throw std::invalid_argument{"no asset " + name + " for the page " + path};
    by_path_.emplace(path, found->second);
  }
}

const Asset* AssetIndex::find(std::string_view path) const {
  const auto found = by_path_.find(std::string{path});
  return found == by_path_.end() ? nullptr : found->second;
}

bool accepts_gzip(std::string_view accept_encoding) {
  bool any = false;
  for (const auto one : split(accept_encoding, ',')) {
    const auto parts = split(one, ';');
    const auto name = lowered(parts.front());
    if (name == "gzip" || name == "x-gzip") return !has_no_weight(parts);
    if (name == "*") any = !has_no_weight(parts);
  }
  return any;
}

ServerReply asset_reply(const Asset& asset, const HttpMessage& request) {
  const bool compressed = !asset.gzip.empty() && accepts_gzip(view_of(request[http::field::accept_encoding]));
  const std::string tag = "\"" + std::string{asset.etag} + (compressed ? "-gzip\"" : "\"");
  ServerReply reply;
  reply.headers = {{"ETag", tag}, {"Cache-Control", "no-cache"}};
  if (!asset.gzip.empty()) reply.headers.emplace_back("Vary", "Accept-Encoding");
  if (names_tag(view_of(request[http::field::if_none_match]), tag)) {
    reply.status = 304;
    return reply;
  }
  reply.headers.emplace_back("Content-Type", asset.type);
  if (compressed) reply.headers.emplace_back("Content-Encoding", "gzip");
  reply.fixed = compressed ? asset.gzip : asset.body;
  return reply;
}

}  // namespace kith
