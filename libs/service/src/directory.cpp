#include "directory.hpp"

#include <algorithm>
#include <utility>

#include "kith/store/json_members.hpp"
#include "kith/store/session_review.hpp"
#include "service_state.hpp"

namespace kith {

void Directory::add(const std::shared_ptr<HostedRoom>& room) {
  rooms_.emplace(room->number(), room);
  if (room->setup().is_waiting_list) {
    waiting_list_ = room->number();
  } else {
    ++num_groups_;
  }
  service_.views.changed(room);
}

std::shared_ptr<HostedRoom> Directory::room_of(std::int64_t number) const {
  const auto found = rooms_.find(number);
  return found == rooms_.end() ? nullptr : found->second;
}

std::shared_ptr<HostedRoom> Directory::room_named(const std::string& name) const {
  if (const auto room = room_of(room_number(name))) return room;
  const auto found =
      std::find_if(rooms_.begin(), rooms_.end(), [&](const auto& room) { return room.second->setup().code == name; });
  return found == rooms_.end() ? nullptr : found->second;
}

void Directory::set_base_url(std::string url) {
  base_url_ = std::move(url);
  service_.views.news();
}

void Directory::set_links(std::string facilitator, std::string observer) {
  facilitator_token_ = std::move(facilitator);
  observer_token_ = std::move(observer);
}

Identity Directory::identify(const std::string& token) const { return tokens_.identify(token, service_.now_us()); }

void Directory::make_link(const Place& place, bool replaces, std::function<void(const std::string& token)> made) {
  const auto issued = Tokens::issue(Role::kParticipant, place.first, place.second, service_.links_expire_us());
  StoreBatch batch{.tokens = {issued.row}};
  if (replaces) batch.revoked = tokens_.of_seat(place.first, place.second);
  const auto former = batch.revoked;
  service_.save(std::move(batch), [this, place, issued, former, made = std::move(made)](bool saved) {
    service_.post([this, place, issued, former, made, saved] {
      if (!saved) return made({});
      tokens_.add(issued);
      for (const auto& hash : former) tokens_.revoke(hash);
      if (const auto room = room_of(place.first)) service_.views.changed(room);
      made(issued.token);
    });
  });
}

void Directory::joined(const Place& place) {
  auto& contact = contacts_[place];
  if (contact.last_seen_us == 0) contact.last_seen_us = service_.now_us();
}

void Directory::move(const Place& from, const Place& to) {
  moved_[from] = to;
  came_from_[to] = from;
  auto contact = contacts_.extract(from);
  if (contact.empty()) return;
  contact.key() = to;
  // That they are away was told to the list alone.
  if (contacts_.insert(std::move(contact)).position->second.is_away) tell_presence(to, "away");
}

Place Directory::place_of(const Identity& identity) const {
  const auto found = moved_.find({identity.room, identity.seat});
  return found == moved_.end() ? Place{identity.room, identity.seat} : found->second;
}

void Directory::seat(const Place& place, const std::string& person, const Json& query) {
  queries_[place] = query;
  if (!person.empty()) seat_of_person_[person] = place;
}

std::optional<Place> Directory::seat_of(const std::string& person) const {
  const auto found = seat_of_person_.find(person);
  if (person.empty() || found == seat_of_person_.end()) return std::nullopt;
  return place_of({.room = found->second.first, .seat = found->second.second});
}

bool Directory::notes(std::string_view type) {
  return type == happening::Joined::kKind.word || type == happening::Consented::kKind.word ||
         type == happening::Declined::kKind.word || type == happening::Released::kKind.word;
}

void Directory::note(std::int64_t room, const std::string& actor, const std::string& type, const Json& body) {
  const auto is = [&](const RoomEventKind& kind) { return type == kind.word; };
  const auto by_actor = static_cast<std::int64_t>(seat_of_actor(actor).value_or(0));
  const auto named = static_cast<std::int64_t>(count_at(body, "seat"));
  if (is(happening::Joined::kKind)) joined({room, named});
  if (is(happening::Consented::kKind)) {
    const auto person = platform_id(*service_.study, body.value("query", Json::object()));
    if (!person.empty()) seat_of_person_[person] = {room, by_actor};
  }
  if (is(happening::Consented::kKind) || is(happening::Declined::kKind)) queries_.erase({room, by_actor});
  if (!is(happening::Declined::kKind) && !is(happening::Released::kKind)) return;
  const Place free{room, is(happening::Released::kKind) ? named : by_actor};
  std::erase_if(seat_of_person_, [&](const auto& person) { return person.second == free; });
}

std::optional<std::string> Directory::link_of(const Place& place) const {
  // Who came from the waiting list still uses the link of their place there.
  auto token = tokens_.known(place.first, place.second);
  if (const auto from = came_from_.find(place); !token && from != came_from_.end()) {
    token = tokens_.known(from->second.first, from->second.second);
  }
  if (!token) return std::nullopt;
  return base_url_ + "/j#t=" + *token;
}

void Directory::fill(WatchedRooms& watched) const {
  const auto page = [&](const char* path, const std::string& token) {
    return token.empty() ? std::string{} : base_url_ + path + token;
  };
  watched.links = {{"facilitator", page("/f#t=", facilitator_token_)},
                   {"observer", page("/f#t=", observer_token_)},
                   {"join", base_url_ + "/j?code=" + service_.join_code},
                   {"code", service_.join_code}};
  watched.num_unsaved = num_unsaved();
  for (auto& room : watched.rooms) {
    for (auto& seat : room.seats) {
      const Place place{room.number, seat.number};
      seat.link = link_of(place);
      const auto contact = contacts_.find(place);
      if (contact == contacts_.end() || !contact->second.connection) continue;
      if (const auto& time = contact->second.connection->round_trip)
        seat.latency_ms = static_cast<double>(time->count()) / 1000.0;
    }
  }
}

std::size_t Directory::num_unsaved() const {
  return static_cast<std::size_t>(
      std::count_if(rooms_.begin(), rooms_.end(), [](const auto& room) { return room.second->is_unsaved(); }));
}

void Directory::check_presence(std::int64_t now) {
  constexpr std::int64_t kAwayAfter = 10 * kSecond;
  for (auto& [place, contact] : contacts_) {
    if (contact.is_away || now - contact.last_seen_us <= kAwayAfter) continue;
    contact.is_away = true;
    tell_presence(place, "away");
  }
}

void Directory::tick() {
  const auto now = service_.now_us();
  check_presence(now);
  for (const auto& [number, room] : rooms_) {
    if (room->next_due_us() <= now || room->is_unsaved()) room->post([room = room] { room->wake(); });
  }
}

}  // namespace kith
