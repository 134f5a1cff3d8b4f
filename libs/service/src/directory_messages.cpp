// Connections: who they are, and what they ask for.
#include <exception>
#include <utility>

#include "directory.hpp"
#include "kith/store/json_members.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::size_t kLongestId = 64;

}  // namespace

void Directory::open(const ConnectionPtr& connection) { connections_.emplace(connection->id, connection); }

void Directory::measured(LiveService::ConnectionId id, std::chrono::microseconds round_trip) {
  const auto found = connections_.find(id);
  if (found != connections_.end()) found->second->round_trip = round_trip;
}

void Directory::closed(LiveService::ConnectionId id) {
  const auto node = connections_.extract(id);
  if (node.empty()) return;
  const auto& connection = node.mapped();
  connection->is_closed = true;
  if (!connection->is_known) return;
  if (connection->identity.role != Role::kParticipant) return service_.views.leave(connection);
  const auto place = place_of(connection->identity);
  const auto contact = contacts_.find(place);
  if (contact != contacts_.end() && contact->second.connection == connection) contact->second.connection = nullptr;
  const auto room = room_of(place.first);
  room->post(
      [room, connection, seat = static_cast<std::size_t>(place.second)] { room->pages().close(seat, connection); });
}

void Directory::say_goodbye() {
  for (const auto& [id, connection] : connections_) connection->dismiss("server-stops", kGoingAway);
}

void Directory::receive(LiveService::ConnectionId id, const std::optional<Json>& frame) {
  const auto found = connections_.find(id);
  if (found == connections_.end() || found->second->is_closed) return;
  const auto connection = found->second;
  try {
    receive(connection, frame);
  } catch (const std::exception&) {
    connection->hang_up(kInternal, "the server has failed");
  }
}

void Directory::receive(const ConnectionPtr& connection, const std::optional<Json>& frame) {
  const auto type = frame ? text_at(*frame, "t") : std::string{};
  if (!connection->is_known) {
    if (type != "hello") return connection->hang_up(kPolicy, "the first message must be a hello");
    return hello(connection, *frame);
  }
  if (!frame) return connection->answer("", Refusal{"bad-frame", "The message is not a JSON object."});
  beat(*connection);
  if (type == "beat") return connection->send({{"t", "beat"}});
  message(connection, type, *frame);
}

void Directory::hello(const ConnectionPtr& connection, const Json& frame) {
  const auto identity = identify(text_at(frame, "token"));
  const bool is_participant = identity.role == Role::kParticipant;
  const auto place = place_of(identity);
  if (identity.role == Role::kNobody || (is_participant && !room_of(place.first)))
    return connection->dismiss("bad-token", kPolicy);

  connection->identity = identity;
  connection->is_known = true;
  connection->socket->authenticated();
  ConnectionPtr former;
  if (is_participant) {
    auto& contact = contacts_[place];
    former = std::exchange(contact.connection, connection);
    contact.last_seen_us = service_.now_us();
    contact.is_away = false;
  }
  if (former && former != connection) former->dismiss("opened-elsewhere", kElsewhere);
  connection->send({{"t", "welcome"}, {"role", name_of(identity.role)}, {"server", service_.options.program}});
  if (is_participant) return attend(connection);
  service_.views.watch(connection);
  for (const auto& [number, room] : rooms_) service_.views.changed(room);
}

// Somebody opened the page of a seat: takes the seat if it was kept free for this link, and shows the page.
void Directory::attend(const ConnectionPtr& connection) {
  const auto [number, place] = place_of(connection->identity);
  const auto room = room_of(number);
  room->post([this, connection, room, place = place] {
    if (connection->is_closed) return;  // another one may have the page by now
    const auto seat = static_cast<std::size_t>(place);
    auto& pages = room->pages();
    const auto attend_there = [this, connection] { service_.post([this, connection] { attend(connection); }); };
    if (pages.has_moved(seat)) return attend_there();  // seated in a group meanwhile
    pages.open(seat, connection);

    const Json body{{"seat", seat}};
    if (!pages.was_taken(seat)) {
      room->ask({.actor = "server", .type = "join", .body = body, .id = {}}, [](const CommandOutcome&) {});
    }
    room->ask({.actor = "server", .type = "present", .body = body, .id = {}},
              [connection, room, seat, attend_there](const CommandOutcome& outcome) {
                if (outcome.refusal && !room->room()) return connection->dismiss("removed", kPolicy);
                if (room->room() == nullptr) return;
                if (room->pages().has_moved(seat)) return attend_there();
                if (seat > room->room()->num_seats()) return connection->dismiss("removed", kPolicy);
                room->pages().show(*room, seat, *connection);
              });
  });
}

void Directory::beat(const Connection& connection) {
  if (connection.identity.role != Role::kParticipant) return;
  const auto place = place_of(connection.identity);
  auto& contact = contacts_[place];
  contact.last_seen_us = service_.now_us();
  if (std::exchange(contact.is_away, false)) tell_presence(place, "present");
}

void Directory::tell_presence(const Place& place, const char* type) const {
  const auto room = room_of(place.first);
  if (!room) return;
  room->post([room, seat = place.second, type] {
    room->ask({.actor = "server", .type = type, .body = {{"seat", seat}}, .id = {}}, [](const CommandOutcome&) {});
  });
}

void Directory::message(const ConnectionPtr& connection, const std::string& type, const Json& frame) {
  const auto id = text_at(frame, "id");
  if (id.empty() || id.size() > kLongestId)
    return connection->answer("", Refusal{"bad-id", "A message needs an id of at most 64 characters."});
  const auto& identity = connection->identity;
  if (type == "hello") return connection->answer(id, Refusal{"not-now", "This connection has already said hello."});
  if (!is_allowed(type, identity.role))
    return connection->answer(id, Refusal{"not-allowed", "This link does not allow '" + type + "'."});
  const auto found = frame.find("body");
  Json body = found == frame.end() ? Json::object() : *found;
  if (!body.is_object()) return connection->answer(id, Refusal{"bad-body", "The body must be an object."});
  if (identity.role != Role::kParticipant) return facilitate(connection, type, id, body);
  if (type == happening::Consented::kKind.command) {
    const auto query = queries_.find(place_of(identity));
    if (query != queries_.end()) body["query"] = query->second;  // otherwise the server was stopped since they joined
  }
  tell_room(connection, type, id, body);
}

// Has the room of a participant decide what they ask for.
void Directory::tell_room(const ConnectionPtr& connection, const std::string& type, const std::string& id,
                          const Json& body) {
  const auto [number, place] = place_of(connection->identity);
  const auto room = room_of(number);
  room->post([this, connection, room, place = place, type, id, body] {
    const auto seat = static_cast<std::size_t>(place);
    if (room->pages().has_moved(seat))  // seated in a group meanwhile
      return service_.post([=, this] { tell_room(connection, type, id, body); });
    room->ask({.actor = seat_actor(seat), .type = type, .body = body, .id = id},
              [connection, id](const CommandOutcome& outcome) { connection->answer(id, outcome.refusal); });
  });
}

void Directory::facilitate(const ConnectionPtr& connection, const std::string& type, const std::string& id,
                           const Json& body) {
  const ServiceLog::Reply reply = [connection, id](const std::optional<Refusal>& refusal) {
    connection->answer(id, refusal);
  };
  if (type == "room-select") return select(connection, body, reply);
  if (type != "link-revoke" && type != "room-make") return ask_room(body, type, id, reply);
  service_.log.carry_out(id, reply, [&](const ServiceLog::Reply& done) {
    if (type == "link-revoke") return revoke_link(id, body, done);
    service_.maker.make(body, "facilitator", id, [done](const RoomMaker::Made& made) { done(made.refusal); });
  });
}

void Directory::select(const ConnectionPtr& connection, const Json& body, const ServiceLog::Reply& reply) {
  const auto name = text_at(body, "room");
  const auto room = room_named(name);
  if (!room && !name.empty()) return reply(no_room());
  service_.views.select(connection, room);
  reply({});
}

void Directory::ask_room(const Json& body, const std::string& type, const std::string& id,
                         const ServiceLog::Reply& reply) {
  const auto room = room_named(text_at(body, "room"));
  if (!room) return reply(no_room());
  auto rest = body;
  rest.erase("room");
  room->post([this, room, type, id, rest, reply] {
    room->ask({.actor = "facilitator", .type = type, .body = rest, .id = id},
              [this, room, type, rest, reply](const CommandOutcome& outcome) {
                reply(outcome.refusal);
                if (outcome.refusal || type != happening::Readmitted::kKind.command) return;
                const Place place{room->number(), static_cast<std::int64_t>(count_at(rest, "seat"))};
                service_.post([this, place] {
                  if (!tokens_.known(place.first, place.second)) make_link(place, false, [](const std::string&) {});
                });
              });
  });
}

void Directory::revoke_link(const std::string& id, const Json& body, const ServiceLog::Reply& reply) {
  auto link = text_at(body, "token");
  const auto mark = link.rfind("#t=");
  if (mark != std::string::npos) link.erase(0, mark + 3);
  const auto whose = identify(link);
  if (whose.role == Role::kNobody) return reply(Refusal{"no-link", "There is no such link."});

  const auto place = place_of(whose);
  const Json what{{"role", name_of(whose.role)},
                  {"room", room_id(place.first)},
                  {"seat", place.second},
                  {"reason", text_at(body, "reason")}};
  const auto done = [this, reply, whose](bool saved) {
    if (!saved) return reply(not_saved());
    tokens_.revoke(whose.hash);
    service_.views.news();
    if (const auto room = room_of(place_of(whose).first)) service_.views.changed(room);
    reply({});
    for (const auto& [number, other] : connections_) {
      if (other->is_known && other->identity.hash == whose.hash) other->dismiss("removed", kPolicy);
    }
  };
  service_.log.record({.revoked = {whose.hash}}, "facilitator", "link-revoke", what, id, done);
}

}  // namespace kith
