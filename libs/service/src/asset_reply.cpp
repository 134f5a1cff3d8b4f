#include "asset_reply.hpp"

#include <algorithm>
#include <boost/beast/http/rfc7230.hpp>
#include <stdexcept>

namespace kith {
namespace {

namespace http = boost::beast::http;

// "gzip;q=0" and "gzip; q=0.000" refuse what they name.
bool has_no_weight(const http::param_list& parameters) {
  return std::any_of(parameters.begin(), parameters.end(), [](const auto& parameter) {
    const auto weight = parameter.second;
    return boost::beast::iequals(parameter.first, "q") && !weight.empty() &&
           weight.find_first_not_of("0.") == boost::beast::string_view::npos;
  });
}

// Whether the client has this copy, as a weak or strong tag; "*" is any. (RFC 9110, 13.1.2: compared weakly.)
bool names_tag(std::string_view if_none_match, const std::string& tag) {
  return if_none_match == "*" || if_none_match.find(tag) != std::string_view::npos;
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
  for (const auto& [name, parameters] : http::ext_list{{accept_encoding.data(), accept_encoding.size()}}) {
    if (boost::beast::iequals(name, "gzip") || boost::beast::iequals(name, "x-gzip")) return !has_no_weight(parameters);
    if (name == "*") any = !has_no_weight(parameters);
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
