#include "waiting_list.hpp"

#include <utility>

#include "kith/core/error.hpp"
#include "kith/store/json_members.hpp"
#include "kith/store/session_review.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

// What happens in a new room: people from the waiting list take their seats.
StoreBatch first_events(const std::shared_ptr<const LiveStudy>& study, const Room& list, const PlannedGroup& group,
                        const RoomSetup& setup, TeachingCache& cache, std::int64_t now_us) {
  StoreBatch batch;
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

void WaitingList::make() {
  auto& directory = service_.directory;
  if (!service_.study->seats_by_ability() || directory.waiting_list() != 0) return;
  auto setup = service_.maker.numbers().setup_for("waiting list", "", {});
  setup.is_waiting_list = true;
  StoredRoom stored{.number = room_number(setup.id), .setup = to_json(setup).dump(), .created_us = service_.now_us()};
  service_.store.file().write(std::vector{StoreBatch{.rooms = {stored}}});
  const auto room = std::make_shared<HostedRoom>(service_, std::move(stored), std::move(setup));
  directory.add(room);
  room->post([room] { room->begin(); });
}

void WaitingList::form_group(HostedRoom& list) {
  if (is_forming_) return;
  const auto group = list.room()->next_group(list.now());
  if (!group) return;
  for (const auto& seat : group->seats) {
    // Only if the list has lost its last events: the person has a place already.
    if (seat && list.pages().has_moved(*seat)) {
      return list.ask({.actor = seat_actor(*seat), .type = "leave", .body = Json::object(), .id = {}},
                      [](const CommandOutcome&) {});
    }
  }
  // They wait, and get a code when their time is over.
  if (service_.directory.num_groups() >= service_.options.max_rooms || service_.free_space < kNoSpace) return;

  const auto setup =
      service_.maker.numbers().setup_for(group->cell.strategy, group->cell.composition, group->simulated);
  const StoredRoom stored{.number = room_number(setup.id), .setup = to_json(setup).dump(), .created_us = list.now()};
  StoreBatch batch;
  try {
    service_.caches.lend([&](TeachingCache& cache) {
      batch = first_events(service_.study, *list.room(), *group, setup, cache, list.now());
    });
  } catch (const std::exception& error) {
    return service_.views.trouble(list.number(), std::string{"a group cannot be formed: "} + error.what());
  }
  batch.rooms.push_back(stored);
  auto body = to_json(*group);
  body["room"] = setup.id;
  is_forming_ = true;
  const auto events = batch.events;
  list.ask(
      {.actor = "server", .type = "group", .body = std::move(body), .id = {}},
      [this, &list, stored, events](const CommandOutcome& outcome) {
        is_forming_ = false;
        if (!outcome.events.empty()) seat_group(list, stored, events);
      },
      std::move(batch));
}

void WaitingList::seat_group(HostedRoom& list, const StoredRoom& stored, const std::vector<StoredEvent>& events) {
  const auto room = std::make_shared<HostedRoom>(service_, stored, room_setup(Json::parse(stored.setup)));
  std::vector<std::pair<Place, Place>> moves;
  for (const auto& event : events) {
    const auto body = body_of(event);
    const auto from = origin_of(body);
    const auto to = count_at(body, "seat");
    list.pages().move(static_cast<std::size_t>(from.second), room->pages(), to);
    moves.emplace_back(from, Place{stored.number, static_cast<std::int64_t>(to)});
  }
  service_.post([this, room, moves = std::move(moves)] {
    service_.directory.add(room);
    for (const auto& [from, to] : moves) service_.directory.move(from, to);
  });
  room->rebuild(events);
}

}  // namespace kith
