// The waiting list: people are screened there, and each group that can be formed of them gets a room of its own.
#include <algorithm>
#include <future>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/store/json_members.hpp"
#include "kith/store/random_token.hpp"
#include "kith/store/session_review.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::size_t kCodeOfGroupLength = 6;

// What happens in a new room: people from the waiting list take their seats.
StoreBatch first_events(const std::shared_ptr<const LiveStudy>& study, const Room& list, const PlannedGroup& group,
                        const RoomSetup& setup, std::int64_t now_us) {
  StoreBatch batch;
  TeachingCache cache{study->atlas};
  Room room{study, setup, cache};
  for (std::size_t m = 0; m < group.seats.size(); ++m) {
    if (!group.seats[m]) continue;
    auto person = list.person_for(*group.seats[m]);
    person["member"] = m;
    const auto decision = room.decide({"server", "seat", std::move(person), {}}, now_us);
    if (decision.refusal) throw Error{ErrorKind::kMismatch, decision.refusal->text};
    room.apply(decision.events.front(), cache);
    batch.events.push_back(to_stored(room_number(setup.id), decision.events.front()));
  }
  return batch;
}

}  // namespace

Place origin_of(const Json& body) {
  const auto from = body.find("from");
  if (from == body.end() || !from->is_object()) return {0, 0};
  return {room_number(text_at(*from, "room")), static_cast<std::int64_t>(count_at(*from, "seat"))};
}

void LiveService::State::make_waiting_list() {
  if (!study->seats_by_ability() || waiting_list != 0) return;
  RoomSetup setup;
  setup.strategy = "waiting list";
  setup.is_waiting_list = true;
  setup.code = random_code(kCodeOfGroupLength);
  setup.salt = random_token();
  waiting_list = next_room++;
  setup.id = room_id(waiting_list);
  StoredRoom stored{.number = waiting_list, .setup = to_json(setup).dump(), .created_us = now_us()};
  auto promise = std::make_shared<std::promise<bool>>();
  auto is_saved = promise->get_future();
  save({.rooms = {stored}}, [promise](bool saved) { promise->set_value(saved); });
  if (!is_saved.get()) throw Error{ErrorKind::kIo, "the waiting list could not be saved: " + store->counters().problem};
  auto room = std::make_shared<HostedRoom>(*this, study, std::move(stored), std::move(setup));
  {
    const std::lock_guard lock{mutex};
    rooms.emplace(waiting_list, room);
    changed_rooms.insert(waiting_list);
  }
  post(waiting_list, [room](TeachingCache& cache) { room->begin(cache); });
}

void LiveService::State::on_waiting(HostedRoom& list) {
  if (is_forming) return;
  const auto group = list.room()->next_group(list.now());
  if (!group) return;
  for (const auto& seat : group->seats) {
    const Place place{list.number(), static_cast<std::int64_t>(seat.value_or(0))};
    const bool is_elsewhere = [&] {
      const std::lock_guard lock{mutex};
      return moved.count(place) != 0;
    }();
    // Only if the list has lost its last events: the person has a place already.
    if (is_elsewhere) {
      return list.ask({.actor = seat_actor(*seat), .type = "leave", .body = Json::object(), .id = {}},
                      [](const CommandOutcome&) {});
    }
  }
  RoomSetup setup;
  setup.strategy = group->cell.strategy;
  setup.composition = group->cell.composition;
  setup.simulated = group->simulated;
  {
    const std::lock_guard lock{mutex};
    // They wait, and get a code when their time is over.
    if (num_groups() >= options.max_rooms || free_space < kNoSpace) return;
    enrol(setup);
  }
  setup.code = random_code(kCodeOfGroupLength);
  setup.salt = random_token();
  const StoredRoom stored{.number = room_number(setup.id), .setup = to_json(setup).dump(), .created_us = list.now()};
  StoreBatch batch;
  try {
    batch = first_events(study, *list.room(), *group, setup, list.now());
  } catch (const std::exception& error) {
    return on_trouble(list.number(), std::string{"a group cannot be formed: "} + error.what());
  }
  batch.rooms.push_back(stored);
  auto body = to_json(*group);
  body["room"] = setup.id;
  is_forming = true;
  const auto events = batch.events;
  list.ask(
      {.actor = "server", .type = "group", .body = std::move(body), .id = {}},
      [this, stored, events](const CommandOutcome& outcome) {
        is_forming = false;
        if (!outcome.events.empty()) seat_group(stored, events);
      },
      std::move(batch));
}

void LiveService::State::seat_group(const StoredRoom& stored, const std::vector<StoredEvent>& events) {
  const auto room = std::make_shared<HostedRoom>(*this, study, stored, room_setup(Json::parse(stored.setup)));
  {
    const std::lock_guard lock{mutex};
    rooms.emplace(stored.number, room);
    changed_rooms.insert(stored.number);
    for (const auto& event : events) {
      const auto body = body_of(event);
      move_person(origin_of(body), {stored.number, static_cast<std::int64_t>(count_at(body, "seat"))});
    }
  }
  room->rebuild(events);
}

void LiveService::State::move_person(const Place& from, const Place& to) {
  moved[from] = to;
  came_from[to] = from;
  joined.insert(to);
  auto contact = contacts.extract(from);
  if (contact.empty()) return;
  contact.key() = to;
  contacts.insert(std::move(contact));
}

Place LiveService::State::place_of(const Identity& identity) const {
  const auto found = moved.find({identity.room, identity.seat});
  return found == moved.end() ? Place{identity.room, identity.seat} : found->second;
}

Place LiveService::State::current_place(const Connection& connection) const {
  const std::lock_guard lock{mutex};
  return place_of(connection.identity);
}

}  // namespace kith
