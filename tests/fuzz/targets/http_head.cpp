// What a client sends before anything is known of it. However the bytes are cut into pieces, the same requests come
// out; what is refused is refused with a status for errors; what an application is asked is a path below /api, and no
// reply has a line that we did not write.

#include <algorithm>
#include <vector>

#include "../fuzzing.hpp"
#include "asset_reply.hpp"
#include "reply.hpp"
#include "request_reader.hpp"
#include "request_rules.hpp"

using namespace kith;

namespace {

const std::vector<Asset>& assets() {
  static const std::vector<Asset> kAssets{{"/assets/live/index.html", "text/html", "aa", "page", "gz"}};
  return kAssets;
}

const RequestRules& rules() {
  static const RequestRules kRules{[] {
    ServerOptions options;
    options.assets = assets();
    options.pages = {{"/j", "/assets/live/index.html"}};
    options.hosts = {"study.example.org"};
    return options;
  }()};
  return kRules;
}

void check_reply(const ServerReply& reply) {
  const auto head = head_of(reply);
  const auto lines = static_cast<std::size_t>(std::count(head.begin(), head.end(), '\n'));
  const auto fixed = security_headers().size() + 3;  // status, date, empty line
  const std::size_t length = reply.status == 304 ? 0 : 1;
  fuzzing::require(lines == fixed + reply.headers.size() + length + (reply.closes ? 1 : 0), "no line of others", head);
  fuzzing::require(!reason_phrase(reply.status).empty(), "a status with a name", head);
}

// What becomes of one request, in a line.
std::string judged(const HttpMessage& request, bool has_body) {
  Destination destination;
  if (const auto refused = rules().judge(request, has_body, destination)) {
    fuzzing::require(refused->status >= 400 && refused->status < 600, "a refusal has a status for errors");
    check_reply(*refused);
    return std::to_string(refused->status) + ";";
  }
  fuzzing::require(!destination.target.empty() && destination.target.front() == '/', "a target is a path");
  if (destination.kind == Destination::Kind::kAsset) {
    check_reply(asset_reply(*destination.asset, request));
  } else if (destination.kind == Destination::Kind::kApplication) {
    fuzzing::require(destination.target.compare(0, 5, "/api/") == 0, "the application is asked below /api");
    if (const auto refused = rules().judge_body(request)) check_reply(*refused);
  }
  return destination.target + "=" + request.body() + ";";
}

std::string outcome_of(std::string_view stream, std::size_t piece) {
  RequestReader reader{ServerLimits{}};
  std::string outcome;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    reader.feed(stream.substr(at, piece));
    while (reader.state() == RequestReader::State::kDone) {
      const bool has_body = reader.has_body();
      outcome += judged(reader.take(), has_body);
    }
    if (reader.state() == RequestReader::State::kFailed) {
      const auto status = reader.failure().status;
      fuzzing::require(status >= 400 && status < 600 && !reader.failure().text.empty(), "a failure says why");
      return outcome + "failed";
    }
  }
  return outcome + std::to_string(static_cast<int>(reader.state()));
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "http_head", .head_bytes = 1, .bytes_one_in = 4};

// The first byte says how long the pieces are. An empty line ends whatever is not complete: a head that cannot become a
// request may be refused as soon as that shows, or when it ends.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  fuzzing::Bytes bytes{input};
  const auto piece = 1 + bytes.below(64);
  const auto stream = std::string{bytes.rest()} + "\r\n\r\n";
  const auto whole = outcome_of(stream, stream.size());
  const auto failed = whole.size() >= 6 && whole.compare(whole.size() - 6, 6, "failed") == 0;
  const auto in_pieces = outcome_of(stream, piece);
  fuzzing::require(in_pieces == whole, "the same requests from pieces", in_pieces + " instead of " + whole);
  return failed ? Outcome::kRefused : Outcome::kRead;
}
