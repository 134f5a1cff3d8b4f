// Requests below /api.
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/live/world_json.hpp"
#include "kith/store/session_export.hpp"
#include "qr_svg.hpp"
#include "service_state.hpp"
#include "tar.hpp"

namespace kith {
namespace {

using HttpReply = LiveService::HttpReply;

constexpr std::string_view kWorlds = "/api/world/";
constexpr std::size_t kLongestQrText = 1000;

std::optional<unsigned> digit_of(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
  return std::nullopt;
}

// The value of a parameter in a query such as "a=1&b=2"; empty if it is not there.
std::string parameter(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const auto end = std::min(query.find('&'), query.size());
    const auto pair = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    const auto equals = std::min(pair.find('='), pair.size());
    if (pair.substr(0, equals) != name) continue;
    std::string value;
    const auto text = pair.substr(std::min(equals + 1, pair.size()));
    for (std::size_t i = 0; i < text.size(); ++i) {
      const auto high = i + 2 < text.size() && text[i] == '%' ? digit_of(text[i + 1]) : std::nullopt;
      const auto low = high ? digit_of(text[i + 2]) : std::nullopt;
      if (low) {
        value += static_cast<char>(*high * 16 + *low);
        i += 2;
      } else {
        value += text[i] == '+' ? ' ' : text[i];
      }
    }
    return value;
  }
  return {};
}

// "/api/world/KEY?a=1" as "/api/world", "KEY" and "a=1". Only worlds have keys.
struct Target {
  explicit Target(const std::string& target) : path{target.substr(0, target.find('?'))} {
    query = target.substr(std::min(path.size() + 1, target.size()));
    if (path.compare(0, kWorlds.size(), kWorlds) != 0) return;
    key = path.substr(kWorlds.size());
    path = "/api/world";
  }
  std::string path, key{}, query{};
};

HttpReply world_reply(const LiveStudy& study, const std::string& key) {
  const auto number = world_of_key(study, key);
  if (!number) return error_reply(404, "not-found", "There is no such world.");
  return {.body = world_json(study, *number).dump(),
          .headers = {{"Cache-Control", "private, max-age=31536000, immutable"}}};
}

HttpReply qr_reply(const std::string& text) {
  const auto picture = text.size() <= kLongestQrText ? qr_svg(text) : std::nullopt;
  if (!picture) return error_reply(400, "bad-text", "A QR code needs a text of 1 to 1000 bytes.");
  return {.content_type = "image/svg+xml", .body = *picture, .headers = {{"Cache-Control", "no-store"}}};
}

HttpReply export_reply(ServiceState& service, const SessionExportOptions& what) {
  try {
    auto file = EventFile::read(service.options.folder);
    std::map<std::string, std::string> files;
    service.caches.lend([&](TeachingCache& cache) {
      export_session(file, service.study, cache, what,
                     [&](std::string_view table, std::string_view piece) { files[std::string{table}] += piece; });
    });
    return {.content_type = "application/x-tar",
            .body = tar_of(files, service.now_us() / kSecond),
            .headers = {{"Content-Disposition", "attachment; filename=\"kith-session.tar\""},
                        {"Cache-Control", "no-store"}}};
  } catch (const std::exception& error) {
    return error_reply(500, "export", error.what());
  }
}

}  // namespace

HttpReply json_reply(int status, const Json& body) {
  return {.status = status, .body = body.dump() + "\n", .headers = {{"Cache-Control", "no-store"}}};
}

HttpReply error_reply(int status, const std::string& reason, const std::string& text) {
  return json_reply(status, {{"error", reason}, {"text", text}});
}

void ServiceState::answer_on(const Strand& strand, const HttpAnswer& answer, std::function<void()> job) {
  strands.post(strand, [answer, job = std::move(job)] {
    try {
      job();
    } catch (const std::exception&) {
      answer(error_reply(500, "internal", "An unexpected error occurred on the server."));
    }
  });
}

void ServiceState::handle(const LiveService::HttpRequest& request, const HttpAnswer& answer) {
  const auto route = request.method + " " + Target{request.target}.path;
  const auto known = permissions();
  if (std::none_of(known.begin(), known.end(), [&](const Permission& permission) { return permission.name == route; }))
    return answer(error_reply(404, "not-found", "There is no such page."));
  if (is_stopping) return answer(error_reply(503, "stopping", "The server is stopping."));
  answer_on(desk, answer, [this, request, route, answer] {
    const auto identity = request.bearer.empty() ? Identity{} : directory.identify(request.bearer);
    if (is_allowed(route, identity.role)) return serve(route, request, answer);
    const int status = identity.role == Role::kNobody ? 401 : 403;
    answer(error_reply(status, "not-allowed", "This link does not allow that."));
  });
}

// On the strand of the desk.
void ServiceState::serve(const std::string& route, const LiveService::HttpRequest& request, const HttpAnswer& answer) {
  const Target target{request.target};
  if (route == "GET /api/health") return answer(json_reply(200, {{"status", "ok"}, {"server", options.program}}));
  if (route == "POST /api/join") return joins.join(request, answer);
  if (route == "GET /api/texts") return answer(json_reply(200, language_json(*study)));
  if (route == "GET /api/world") {
    return answer_on(pages, answer, [=, this] {
      const auto known = worlds.find(target.key);
      if (known != worlds.end()) return answer(known->second);
      const auto reply = world_reply(*study, target.key);
      if (reply.status == 200) worlds[target.key] = reply;
      answer(reply);
    });
  }
  if (route == "GET /api/integrity") {
    return views.integrity(directory.num_unsaved(), [answer](const Json& counts) { answer(json_reply(200, counts)); });
  }
  if (route == "GET /api/qr") return answer(qr_reply(parameter(target.query, "text")));

  // What is left is GET /api/export.
  SessionExportOptions what;
  if (const auto name = parameter(target.query, "room"); !name.empty()) {
    const auto room = directory.room_named(name);
    if (!room) return answer(error_reply(404, "no-room", "There is no such room."));
    what.room = room->number();
  }
  answer_on(exports, answer, [=, this] { answer(export_reply(*this, what)); });
}

}  // namespace kith
