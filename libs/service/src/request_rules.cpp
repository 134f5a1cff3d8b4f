#include "request_rules.hpp"

#include <algorithm>
#include <boost/beast/http/rfc7230.hpp>

#include "json_depth.hpp"

namespace kith {
namespace {

namespace http = boost::beast::http;
using http::field;

ServerReply refusal(int status, std::string text, std::vector<std::pair<std::string, std::string>> headers = {}) {
  auto reply = plain_reply(status, std::move(text));
  for (auto& header : headers) reply.headers.push_back(std::move(header));
  return reply;
}

bool has_token(boost::beast::string_view list, boost::beast::string_view token) {
  return http::token_list{list}.exists(token);
}

// A key is 16 bytes in base64 (RFC 6455, 4.1).
bool is_web_socket_key(std::string_view key) {
  const auto is_base64 = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '+' || c == '/';
  };
  return key.size() == 24 && key.substr(22) == "==" && std::all_of(key.begin(), key.begin() + 22, is_base64);
}

bool is_visible_ascii(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > 0x20 && c < 0x7f; });
}

constexpr std::string_view kApplicationPath = "/api/";
constexpr std::string_view kWebSocketPath = "/ws";

}  // namespace

RequestRules::RequestRules(const ServerOptions& options)
    : limits_{options.limits}, site_{options.hosts, options.origins}, assets_{options.assets, options.pages} {}

// What is wrong with the message, whatever it asks for.
std::optional<ServerReply> RequestRules::judge_message(const HttpMessage& head) const {
  const auto hosts = head.count(field::host);
  if (hosts != 1) return refusal(400, hosts == 0 ? "the Host field is missing" : "there are several Host fields");
  if (head.target().size() > limits_.target_bytes) return refusal(414, "the address is too long");
  if (head.count(field::transfer_encoding) > 0) {
    if (head.version() < 11) return refusal(400, "HTTP/1.0 has no Transfer-Encoding");
    if (!head.chunked()) return refusal(501, "the only Transfer-Encoding known here is chunked");
  }
  if (head.method() == http::verb::unknown) return refusal(501, "this method is not known here");
  const auto expect = head[field::expect];
  if (!expect.empty() && !boost::beast::iequals(expect, "100-continue")) {
    return refusal(417, "this expectation cannot be met");
  }
  return std::nullopt;
}

// The target may name the host too, which then counts (RFC 9112, 3.2.2).
std::optional<ServerReply> RequestRules::judge_host(const HttpMessage& head, std::string& target) const {
  target = std::string{view_of(head.target())};
  auto host = view_of(head[field::host]);
  HostAndPort parts;
  if (!parse_host(host, parts)) return refusal(400, "the Host field names no host");
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (target.compare(0, scheme.size(), scheme) != 0) continue;
    const auto path = std::min(target.find('/', scheme.size()), target.size());
    const auto authority = target.substr(scheme.size(), path - scheme.size());
    if (!site_.is_ours(authority)) return refusal(421, "this server has another name");
    target = path == target.size() ? "/" : target.substr(path);
    return std::nullopt;
  }
  if (!site_.is_ours(host)) {
    return refusal(421, "this server has another name; start it with --public-url or --lan if this one is right");
  }
  return std::nullopt;
}

bool RequestRules::is_from_our_page(const HttpMessage& head) const {
  const auto count = head.count(field::origin);
  if (count == 0) return true;  // no browser: it has no rights to lend to others
  return count == 1 && site_.may_talk(view_of(head[field::origin]), view_of(head[field::host]));
}

std::optional<ServerReply> RequestRules::judge_upgrade(const HttpMessage& head, bool has_body) const {
  if (head.method() != http::verb::get) return refusal(405, "use GET", {{"Allow", "GET"}});
  if (head.version() < 11 || !has_token(head[field::connection], "upgrade") ||
      !has_token(head[field::upgrade], "websocket")) {
    return refusal(426, "this address is for WebSockets", {{"Upgrade", "websocket"}});
  }
  if (view_of(head[field::sec_websocket_version]) != "13") {
    return refusal(426, "only version 13 of WebSockets is known here",
                   {{"Upgrade", "websocket"}, {"Sec-WebSocket-Version", "13"}});
  }
  if (head.count(field::sec_websocket_key) != 1 || !is_web_socket_key(view_of(head[field::sec_websocket_key]))) {
    return refusal(400, "Sec-WebSocket-Key must be 16 bytes in base64");
  }
  if (has_body) return refusal(400, "a request to open a WebSocket has no body");
  if (!is_from_our_page(head)) return refusal(403, "pages of other sites must not open WebSockets here");
  return std::nullopt;
}

std::optional<ServerReply> RequestRules::judge(const HttpMessage& head, bool has_body, Destination& destination) const {
  if (auto refused = judge_message(head)) return refused;
  if (head.method() == http::verb::options && head.target() == "*") {
    return refusal(405, "use GET", {{"Allow", "GET, HEAD, POST"}});
  }
  if (auto refused = judge_host(head, destination.target)) return refused;
  if (destination.target.empty() || destination.target.front() != '/' || !is_visible_ascii(destination.target)) {
    return refusal(400, "the address must begin with '/'");
  }
  const auto path = std::string_view{destination.target}.substr(0, destination.target.find('?'));
  if (path == kWebSocketPath) {
    destination.kind = Destination::Kind::kWebSocket;
    return judge_upgrade(head, has_body);
  }
  const auto method = head.method();
  const bool reads = method == http::verb::get || method == http::verb::head;
  if (path.substr(0, kApplicationPath.size()) == kApplicationPath) {
    destination.kind = Destination::Kind::kApplication;
    if (!reads && method != http::verb::post) return refusal(405, "use GET or POST", {{"Allow", "GET, HEAD, POST"}});
    if (method == http::verb::post) {
      if (!is_from_our_page(head)) return refusal(403, "pages of other sites must not send anything here");
      const auto type = view_of(head[field::content_type]);
      if (!boost::beast::iequals(head[field::content_type].substr(0, type.find(';')), "application/json")) {
        return refusal(415, "the Content-Type must be application/json");
      }
    }
    return std::nullopt;
  }
  destination.kind = Destination::Kind::kAsset;
  destination.asset = assets_.find(path);
  if (destination.asset == nullptr) return refusal(404, "there is no page at this address");
  if (!reads) return refusal(405, "use GET", {{"Allow", "GET, HEAD"}});
  return std::nullopt;
}

std::optional<ServerReply> RequestRules::judge_body(const HttpMessage& request) const {
  if (json_nests_within(request.body(), limits_.json_depth)) return std::nullopt;
  return refusal(400, "the JSON nests too deeply or has a zero byte");
}

}  // namespace kith
