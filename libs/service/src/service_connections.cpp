// Connections: who they are, what they ask for, what they are shown.
#include <algorithm>
#include <utility>

#include "kith/store/json_members.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::uint16_t kPolicy = 1008;
constexpr std::uint16_t kElsewhere = 4001;  // of the range for applications
constexpr int kDeepest = 32;

// The frame as an object, or nothing. Nesting is limited, since what is nested deeply costs more than it is long.
std::optional<Json> parse_frame(std::string_view text) {
  bool is_deep = false;
  const auto watch = [&](int depth, Json::parse_event_t, Json&) {
    is_deep = is_deep || depth > kDeepest;
    return !is_deep;
  };
  auto json = Json::parse(text, watch, false);
  if (is_deep || json.is_discarded() || !json.is_object()) return std::nullopt;
  return json;
}

}  // namespace

Json ack_frame(const std::string& id) { return {{"t", "ack"}, {"id", id}}; }

Json nak_frame(const std::string& id, const Refusal& refusal) {
  return {{"t", "nak"}, {"id", id}, {"reason", refusal.reason}, {"text", refusal.text}};
}

void Connection::dismiss(const char* reason, std::uint16_t code) {
  if (is_closed.exchange(true)) return;
  send({{"t", "bye"}, {"reason", reason}});
  socket->close(code, reason);
}

void Connection::hang_up(std::uint16_t code, const char* reason) {
  if (!is_closed.exchange(true)) socket->close(code, reason);
}

LiveService::ConnectionId LiveService::open(std::shared_ptr<Socket> socket, std::string /*remote*/) {
  auto& state = *state_;
  auto connection = std::make_shared<Connection>();
  connection->socket = std::move(socket);
  const std::lock_guard lock{state.mutex};
  connection->id = state.next_connection++;
  state.connections.emplace(connection->id, connection);
  return connection->id;
}

std::shared_ptr<Connection> LiveService::State::connection_of(ConnectionId id) const {
  const std::lock_guard lock{mutex};
  const auto found = connections.find(id);
  return found == connections.end() ? nullptr : found->second;
}

void LiveService::closed(ConnectionId id) {
  auto& state = *state_;
  const std::lock_guard lock{state.mutex};
  const auto found = state.connections.find(id);
  if (found == state.connections.end()) return;
  const auto connection = found->second;
  state.connections.erase(found);
  connection->is_closed = true;
  if (!connection->is_known) return;
  const auto& identity = connection->identity;
  if (identity.role != Role::kParticipant) {
    --state.num_facilitators;
    const auto selected = state.selected.find(connection->selected);
    if (selected != state.selected.end()) state.selected.erase(selected);
    return;
  }
  const auto contact = state.contacts.find(state.place_of(identity));
  if (contact != state.contacts.end() && contact->second.connection == id) contact->second.connection = 0;
}

void LiveService::measured(ConnectionId id, std::chrono::microseconds round_trip) {
  const std::lock_guard lock{state_->mutex};
  const auto found = state_->connections.find(id);
  if (found != state_->connections.end()) found->second->round_trip = round_trip;
}

void LiveService::receive(ConnectionId id, std::string_view text) {
  auto& state = *state_;
  const auto connection = state.connection_of(id);
  if (!connection || connection->is_closed) return;
  const auto frame = parse_frame(text);
  const auto type = frame ? text_at(*frame, "t") : std::string{};
  if (!connection->is_known) {
    if (type != "hello") return connection->hang_up(kPolicy, "the first message must be a hello");
    return state.hello(connection, *frame);
  }
  if (!frame) return connection->send(nak_frame("", {"bad-frame", "The message is not a JSON object."}));
  if (type == "beat") {
    state.beat(*connection);
    return connection->send({{"t", "beat"}});
  }
  state.beat(*connection);
  state.message(connection, type, *frame);
}

void LiveService::State::hello(const std::shared_ptr<Connection>& connection, const Json& frame) {
  std::shared_ptr<Connection> former;
  {
    const std::lock_guard lock{mutex};
    const auto now = now_us();
    auto identity = is_stopping ? Identity{} : tokens->identify(text_at(frame, "token"), now);
    const auto place = place_of(identity);
    const bool has_room = identity.role != Role::kParticipant || rooms.find(place.first) != rooms.end();
    if (identity.role == Role::kNobody || !has_room) identity = {};
    connection->identity = identity;

    if (identity.role == Role::kParticipant) {
      auto& contact = contacts[place];
      const auto found = connections.find(std::exchange(contact.connection, connection->id));
      if (found != connections.end() && found->second != connection) former = found->second;
      contact.last_seen_us = now;
      contact.is_away = false;
    } else if (identity.role != Role::kNobody) {
      ++num_facilitators;
      selected.insert(0);
      for (const auto& [number, room] : rooms) changed_rooms.insert(number);
      await_news();
    }
    if (identity.role != Role::kNobody) connection->is_known = true;
  }

  if (!connection->is_known) return connection->dismiss("bad-token", kPolicy);
  connection->socket->authenticated();
  if (former) former->dismiss("opened-elsewhere", kElsewhere);
  connection->send({{"t", "welcome"}, {"role", name_of(connection->identity.role)}, {"server", options.program}});
  if (connection->identity.role == Role::kParticipant) attend(connection);
}

// Somebody opened the page of a seat: takes the seat if it was kept free for this link, and shows the page.
void LiveService::State::attend(const std::shared_ptr<Connection>& connection) {
  const auto place = current_place(*connection);
  const auto [number, seat] = place;
  post(number, [this, connection, place, number = number, seat = seat](TeachingCache&) {
    if (current_place(*connection) != place) return attend(connection);  // seated in a group meanwhile
    const auto room = room_of(number);
    const auto show = [this, connection, room, place](const CommandOutcome& outcome) {
      if (outcome.refusal && !room->room()) return connection->dismiss("removed", kPolicy);
      if (room->room() == nullptr) return;
      if (current_place(*connection) != place) return attend(connection);
      const auto own = static_cast<std::size_t>(place.second);
      if (own > room->room()->num_seats()) return connection->dismiss("removed", kPolicy);
      push_page(*connection, *room, own);
    };
    const bool is_new = [&] {
      const std::lock_guard lock{mutex};
      return joined.find({number, seat}) == joined.end();
    }();
    if (is_new) {
      room->ask({.actor = "server", .type = "join", .body = {{"seat", seat}}, .id = {}}, [](const CommandOutcome&) {});
    }
    room->ask({.actor = "server", .type = "present", .body = {{"seat", seat}}, .id = {}}, show);
  });
}

void LiveService::State::beat(const Connection& connection) {
  if (connection.identity.role != Role::kParticipant) return;
  bool is_back = false;
  Place place;
  {
    const std::lock_guard lock{mutex};
    place = place_of(connection.identity);
    auto& contact = contacts[place];
    contact.last_seen_us = now_us();
    is_back = std::exchange(contact.is_away, false);
  }
  if (is_back) tell_presence(place.first, place.second, "present");
}

void LiveService::State::tell_presence(std::int64_t number, std::int64_t seat, const char* type) {
  post(number, [this, number, seat, type](TeachingCache&) {
    if (const auto room = room_of(number))
      room->ask({.actor = "server", .type = type, .body = {{"seat", seat}}, .id = {}}, [](const CommandOutcome&) {});
  });
}

void LiveService::State::message(const std::shared_ptr<Connection>& connection, const std::string& type,
                                 const Json& frame) {
  const auto id = text_at(frame, "id");
  if (id.empty() || id.size() > kLongestId)
    return connection->send(nak_frame("", {"bad-id", "A message needs an id of at most 64 characters."}));
  const auto& identity = connection->identity;
  if (type == "hello") return connection->send(nak_frame(id, {"not-now", "This connection has already said hello."}));
  if (!is_allowed(type, identity.role))
    return connection->send(nak_frame(id, {"not-allowed", "This link does not allow '" + type + "'."}));
  const auto found = frame.find("body");
  Json body = found == frame.end() ? Json::object() : *found;
  if (!body.is_object()) return connection->send(nak_frame(id, {"bad-body", "The body must be an object."}));
  if (identity.role != Role::kParticipant) return facilitate(connection, type, id, body);
  const auto place = current_place(*connection);
  if (type == happening::Consented::kKind.command) {
    const std::lock_guard lock{mutex};
    const auto query = queries.find(place);
    body["query"] = query == queries.end() ? Json::object() : query->second;
  }
  tell_room(connection, type, id, body);
}

// Has the room of a participant decide what they ask for.
void LiveService::State::tell_room(const std::shared_ptr<Connection>& connection, const std::string& type,
                                   const std::string& id, const Json& body) {
  const auto place = current_place(*connection);
  post(place.first, [this, connection, place, type, id, body](TeachingCache&) {
    if (current_place(*connection) != place) return tell_room(connection, type, id, body);  // seated meanwhile
    const auto seat = static_cast<std::size_t>(place.second);
    room_of(place.first)
        ->ask({.actor = seat_actor(seat), .type = type, .body = body, .id = id},
              [connection, id](const CommandOutcome& outcome) {
                connection->send(outcome.refusal ? nak_frame(id, *outcome.refusal) : ack_frame(id));
              });
  });
}

void LiveService::State::facilitate(const std::shared_ptr<Connection>& connection, const std::string& type,
                                    const std::string& id, const Json& body) {
  const Reply reply = [connection, id](const std::optional<Refusal>& refusal) {
    connection->send(refusal ? nak_frame(id, *refusal) : ack_frame(id));
  };
  if (type == "room-select") return select_room(connection, body, reply);
  if (type == "link-revoke" || type == "room-make") {
    return post(0, [this, type, body, id, reply](TeachingCache&) {
      carry_out(id, reply, [&](const Reply& done) {
        if (type == "link-revoke") return revoke_link(id, body, done);
        make_rooms(body, "facilitator", id, [done](const RoomsMade& made) { done(made.refusal); });
      });
    });
  }
  const auto room = room_named(text_at(body, "room"));
  if (!room) return reply(Refusal{"no-room", "There is no such room."});
  auto rest = body;
  rest.erase("room");
  post(room->number(), [this, room, type, id, rest, reply](TeachingCache&) {
    room->ask({.actor = "facilitator", .type = type, .body = rest, .id = id},
              [this, room, type, rest, reply](const CommandOutcome& outcome) {
                reply(outcome.refusal);
                if (outcome.refusal || type != happening::Readmitted::kKind.command) return;
                const auto seat = static_cast<std::int64_t>(count_at(rest, "seat"));
                const bool has_link = [&] {
                  const std::lock_guard lock{mutex};
                  return tokens->known(room->number(), seat).has_value();
                }();
                if (!has_link) make_link(room->number(), seat, [](const std::string&) {});
              });
  });
}

void LiveService::State::carry_out(const std::string& id, Reply reply, const std::function<void(Reply)>& act) {
  if (seen_messages.count(id) > 0) return reply({});
  auto& waiting = open_messages[id];
  waiting.push_back(std::move(reply));
  if (waiting.size() > 1) return;
  act([this, id](const std::optional<Refusal>& refusal) {
    if (!refusal) seen_messages.insert(id);
    const auto senders = open_messages.extract(id);
    for (const auto& send : senders.mapped()) send(refusal);
  });
}

void LiveService::State::select_room(const std::shared_ptr<Connection>& connection, const Json& body,
                                     const Reply& reply) {
  const auto name = text_at(body, "room");
  const auto room = room_named(name);
  if (!room && !name.empty()) return reply(Refusal{"no-room", "There is no such room."});
  {
    const std::lock_guard lock{mutex};
    if (connection->is_closed) return;
    const auto number = room ? room->number() : 0;
    const auto former = selected.find(std::exchange(connection->selected, number));
    if (former != selected.end()) selected.erase(former);
    selected.insert(number);
    changed_rooms.insert(number);
    await_news();
  }
  reply({});
}

void LiveService::State::revoke_link(const std::string& id, const Json& body, const Reply& reply) {
  auto link = text_at(body, "token");
  const auto mark = link.rfind("#t=");
  if (mark != std::string::npos) link.erase(0, mark + 3);

  Identity whose;
  Place place;
  {
    const std::lock_guard lock{mutex};
    whose = tokens->identify(link, now_us());
    place = place_of(whose);
  }
  if (whose.role == Role::kNobody) return reply(Refusal{"no-link", "There is no such link."});

  StoreBatch batch;
  batch.revoked.push_back(whose.hash);
  const Json what{{"role", name_of(whose.role)},
                  {"room", room_id(place.first)},
                  {"seat", place.second},
                  {"reason", text_at(body, "reason")}};
  record(std::move(batch), "facilitator", "link-revoke", what, id, [this, reply, whose](bool saved) {
    if (!saved) return reply(Refusal{"not-saved", "This could not be saved; try again."});
    std::vector<std::shared_ptr<Connection>> users;
    {
      const std::lock_guard lock{mutex};
      tokens->revoke(whose.hash);
      has_news = true;
      if (whose.role == Role::kParticipant) changed_rooms.insert(place_of(whose).first);
      for (const auto& [number, other] : connections) {
        if (other->is_known && other->identity.hash == whose.hash) users.push_back(other);
      }
    }

    reply({});
    for (const auto& user : users) user->dismiss("removed", kPolicy);
  });
}

// Sends a view unless it is the last one, apart from the time.
void LiveService::State::push_view(Connection& connection, Json view) const {
  if (connection.is_closed) return;
  const auto time = view.find("server_ms");
  const Json now = time == view.end() ? Json{} : *time;
  if (time != view.end()) *time = 0;
  auto text = view.dump();
  if (text == connection.last_view) return;
  connection.last_view = std::move(text);
  if (time != view.end()) *time = now;
  connection.send({{"t", "view"}, {"view", std::move(view)}});
}

// Shows somebody their page; if there is none, that ends their connection and nothing else.
void LiveService::State::push_page(Connection& connection, const HostedRoom& hosted, std::size_t seat) {
  if (connection.is_closed) return;
  const Viewer viewer{.role = Viewer::Role::kParticipant, .seat = seat};
  const bool is_shown = can_show(hosted, "page of seat " + std::to_string(seat),
                                 [&] { push_view(connection, hosted.room()->view(viewer, now_us())); });
  if (!is_shown) connection.dismiss("no-view", kGoingAway);
}

// Shows everybody in a room what has become of it.
void LiveService::State::push_room(HostedRoom& hosted) {
  const auto* room = hosted.room();
  if (room == nullptr) return;
  std::vector<std::pair<std::size_t, std::shared_ptr<Connection>>> people;
  {
    const std::lock_guard lock{mutex};
    for (auto at = contacts.lower_bound({hosted.number(), 0});
         at != contacts.end() && at->first.first == hosted.number(); ++at) {
      const auto found = connections.find(at->second.connection);
      if (found != connections.end()) people.emplace_back(static_cast<std::size_t>(at->first.second), found->second);
    }
  }
  for (const auto& [seat, person] : people) {
    if (seat <= room->num_seats() && room->is_person(seat)) push_page(*person, hosted, seat);
  }
}

void LiveService::State::check_presence(std::int64_t now) {
  constexpr std::int64_t kAwayAfter = 10 * kSecond;
  std::vector<std::pair<std::int64_t, std::int64_t>> gone;
  {
    const std::lock_guard lock{mutex};
    for (auto& [place, contact] : contacts) {
      if (contact.is_away || now - contact.last_seen_us <= kAwayAfter) continue;
      contact.is_away = true;
      gone.push_back(place);
    }
  }
  for (const auto& [room, seat] : gone) tell_presence(room, seat, "away");
}

void LiveService::stop() {
  auto& state = *state_;
  std::vector<std::shared_ptr<Connection>> all;
  {
    const std::lock_guard lock{state.mutex};
    if (std::exchange(state.is_stopping, true)) return;
    for (const auto& [id, connection] : state.connections) all.push_back(connection);
  }
  state.ticks.notify_all();
  if (state.ticker.joinable()) state.ticker.join();
  for (const auto& connection : all) connection->dismiss("server-stops", kGoingAway);
  state.teachers->stop();
  state.busy.wait_for_none();
  std::vector<std::shared_ptr<HostedRoom>> rooms;
  {
    const std::lock_guard lock{state.mutex};
    for (const auto& [number, room] : state.rooms) rooms.push_back(room);
  }
  for (const auto& room : rooms) state.post(room->number(), [room](TeachingCache&) { room->abandon(); });
  state.busy.wait_for_none();
}

}  // namespace kith
