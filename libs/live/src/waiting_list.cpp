#include <algorithm>

#include "kith/live/screening.hpp"
#include "message_json.hpp"
#include "room_state.hpp"

namespace kith {
namespace {

bool is_waiting(const LiveSeat& seat) {
  return seat.status == SeatStatus::kActive && seat.readiness == Readiness::kReady && seat.is_here;
}

bool wants_high(const LiveStudy& study, char letter) {
  return study.group().high_types.find(letter) != std::string::npos;
}

std::string key_of(const LiveCell& cell) { return cell.strategy + "/" + cell.composition; }

// A cell of the design, and how many groups of it were formed.
struct CountedCell {
  LiveCell cell;
  std::size_t groups = 0;
};

// All cells, those with the fewest groups first.
std::vector<CountedCell> cells_in_turn(const RoomParts& room) {
  std::vector<CountedCell> cells;
  for (auto& cell : live_cells(room.study)) {
    const auto found = room.state.groups.find(key_of(cell));
    cells.push_back({std::move(cell), found == room.state.groups.end() ? 0 : found->second});
  }
  std::stable_sort(cells.begin(), cells.end(),
                   [](const CountedCell& a, const CountedCell& b) { return a.groups < b.groups; });
  return cells;
}

// People who can be seated, the longest wait first.
std::vector<std::size_t> people_waiting(const Room::State& state) {
  std::vector<std::size_t> people;
  for (std::size_t i = 0; i < state.seats.size(); ++i) {
    if (is_waiting(state.seats[i])) people.push_back(i);
  }
  std::stable_sort(people.begin(), people.end(),
                   [&](std::size_t a, std::size_t b) { return state.seats[a].ready_us < state.seats[b].ready_us; });
  return people;
}

// A group of this cell; every place goes to the person who has waited for longest among those whom it is for. Places
// that nobody fits go to stand-ins if wanted; otherwise there is no group.
std::optional<PlannedGroup> planned(const RoomParts& room, const LiveCell& cell, const std::vector<std::size_t>& people,
                                    bool fills_up) {
  PlannedGroup group{.cell = cell, .simulated = simulated_members(room.study, cell.composition.size()), .seats = {}};
  group.seats.resize(cell.composition.size());
  std::vector<bool> is_used(people.size());
  for (std::size_t m = 0; m < group.seats.size(); ++m) {
    if (group.simulated[m]) continue;
    const bool high = wants_high(room.study, cell.composition[m]);
    for (std::size_t i = 0; i < people.size() && !group.seats[m]; ++i) {
      if (is_used[i] || has_high_estimate(room, room.state.seats[people[i]]) != high) continue;
      is_used[i] = true;
      group.seats[m] = people[i] + 1;
    }
    if (group.seats[m]) continue;
    if (!fills_up) return std::nullopt;
    group.simulated[m] = true;
  }
  const bool has_people = std::any_of(group.seats.begin(), group.seats.end(), [](const auto& seat) { return seat; });
  return has_people ? std::optional{std::move(group)} : std::nullopt;
}

// Whether waiting comes to an end by itself.
bool has_limit(const RoomParts& room) { return room.study.group().auto_start && room.study.group().time.lobby_s > 0; }

std::int64_t lobby_us(const RoomParts& room) { return room.study.group().time.lobby_s * kSecond; }

}  // namespace

bool has_high_estimate(const RoomParts& room, const LiveSeat& seat) {
  const auto right = static_cast<std::size_t>(std::count(seat.screened.begin(), seat.screened.end(), true));
  return screening_estimate(right, seat.screened.size()) >= room.study.group().screening.cut;
}

bool has_place_for(const LiveStudy& study, const LiveCell& cell, bool high) {
  const auto simulated = simulated_members(study, cell.composition.size());
  for (std::size_t m = 0; m < simulated.size(); ++m) {
    if (!simulated[m] && wants_high(study, cell.composition[m]) == high) return true;
  }
  return false;
}

std::optional<PlannedGroup> next_group_in(const RoomParts& room, std::int64_t now_us) {
  if (!room.setup.is_waiting_list || room.state.phase != RoomPhase::kLobby) return std::nullopt;
  const auto people = people_waiting(room.state);
  if (people.empty()) return std::nullopt;
  const auto cells = cells_in_turn(room);
  // Otherwise those that are formed easily would get all the groups.
  const bool is_balanced = has_limit(room);
  for (const auto& [cell, groups] : cells) {
    if (is_balanced && groups > cells.front().groups) break;
    if (auto group = planned(room, cell, people, false)) return group;
  }
  const auto& first = room.state.seats[people.front()];
  if (!is_balanced || now_us < first.ready_us + lobby_us(room)) return std::nullopt;
  // Any group will do for whoever has waited for too long. They get the first place that they fit.
  const bool may_fill = room.study.group().dropout.policy == DropoutPolicy::kSimulate;
  for (const bool fills_up : {false, true}) {
    for (const auto& [cell, groups] : cells) {
      if ((fills_up && !may_fill) || !has_place_for(room.study, cell, has_high_estimate(room, first))) continue;
      if (auto group = planned(room, cell, people, fills_up)) return group;
    }
  }
  return std::nullopt;
}

std::optional<std::int64_t> last_call_in(const RoomParts& room) {
  if (!room.setup.is_waiting_list || room.state.phase != RoomPhase::kLobby || !has_limit(room)) return std::nullopt;
  const auto people = people_waiting(room.state);
  if (people.empty()) return std::nullopt;
  return room.state.seats[people.front()].ready_us + lobby_us(room);
}

std::int64_t longest_wait_us(const RoomParts& room) {
  if (!has_limit(room)) return 0;
  const auto call_us = last_call_in(room);
  // A group that is being formed is not torn apart. If it cannot be, the wait ends in any case.
  return call_us && next_group_in(room, *call_us) ? 2 * lobby_us(room) : lobby_us(room);
}

Json to_json(const PlannedGroup& group) {
  return {{"strategy", group.cell.strategy},
          {"composition", group.cell.composition},
          {"simulated", group.simulated},
          {"seats", written(group.seats)}};
}

std::optional<PlannedGroup> Room::next_group(std::int64_t now_us) const {
  return next_group_in({*study_, *setup_, *state_}, std::max(now_us, state_->last_us));
}

std::optional<std::int64_t> Room::last_call() const { return last_call_in({*study_, *setup_, *state_}); }

Json Room::person_for(std::size_t seat) const {
  const auto& person = state_->seats.at(seat - 1);
  return {{"from", {{"room", setup_->id}, {"seat", seat}}},
          {"version", study_->group().consent_version},
          {"query", person.query.is_object() ? person.query : Json::object()},
          {"name", person.name},
          {"screened", person.screened},
          {"ready_us", person.ready_us}};
}

}  // namespace kith
