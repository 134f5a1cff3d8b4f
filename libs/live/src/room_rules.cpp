#include <algorithm>

#include "room_state.hpp"

namespace kith {

bool gates(const LiveSeat& seat) noexcept {
  return seat.is_person && seat.status == SeatStatus::kActive && seat.in_period;
}

std::size_t num_active_people(const Room::State& state) noexcept {
  return static_cast<std::size_t>(std::count_if(state.seats.begin(), state.seats.end(), [](const LiveSeat& seat) {
    return seat.is_person && seat.member && seat.status == SeatStatus::kActive;
  }));
}

bool is_taken(const Room::State& state, const LiveMember& member) noexcept {
  return member.seat && state.seats[*member.seat].status == SeatStatus::kActive;
}

bool is_running(const Room::State& state) noexcept { return rules_of(state.phase).stage == RoomStage::kRunning; }

std::string stage_of_seat(const RoomParts& room, const LiveSeat& seat) {
  if (!seat.is_person) return {};
  if (seat.status == SeatStatus::kGone) return seat.last_page;
  // Somebody who opens their link when it is all over.
  if (seat.status == SeatStatus::kEmpty && room.state.phase == RoomPhase::kEnded) return "ended";
  if (seat.status == SeatStatus::kEmpty || seat.readiness == Readiness::kConsent) return "consent";
  if (seat.readiness == Readiness::kCheck) return "check";
  if (seat.readiness == Readiness::kScreening) return "screening";
  if (room.state.phase == RoomPhase::kLobby || !seat.member) return "lobby";
  if (room.state.phase == RoomPhase::kQuestions && seat.examined) return std::string{kExamPage};
  if (room.state.phase == RoomPhase::kQuestions || room.state.phase == RoomPhase::kEnded) {
    return room.study.group().questions.empty() || seat.has_answered_questions ? "debrief" : "questions";
  }
  if (!seat.in_period || has_done_phase(room.state, seat)) return "wait";
  return std::string{rules_of(room.state.phase).word};
}

std::string status_of_seat(const RoomParts& room, const LiveSeat& seat) {
  if (!seat.is_person) return "simulated";
  if (seat.status == SeatStatus::kEmpty) return "empty";
  if (seat.status == SeatStatus::kGone) {
    if (seat.last_page != "ended") return seat.last_page;  // declined, full, moved or replaced
    if (seat.why == "left" || seat.why == "withdrawn") return seat.why;
    return seat.had_dropped ? "dropped" : "ended";
  }
  if (seat.status == SeatStatus::kDropped && !seat.has_answered_questions) return "dropped";
  return stage_of_seat(room, seat) == "debrief" ? "finished" : "active";
}

std::size_t current_test(const LiveSeat& seat) noexcept {
  const auto first = std::find_if(seat.paths.begin(), seat.paths.end(), [](const auto& path) { return !path; });
  return static_cast<std::size_t>(first - seat.paths.begin());
}

std::size_t current_choice(const LiveSeat& seat) noexcept {
  const auto first = std::find_if(seat.choices.begin(), seat.choices.end(), [](const auto& one) { return !one; });
  return static_cast<std::size_t>(first - seat.choices.begin());
}

std::optional<std::size_t> own_entry(const Room::State& state, std::size_t test, std::size_t member) {
  const auto& entries = state.board.at(test);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const auto& members = entries[e].members;
    if (std::find(members.begin(), members.end(), member) != members.end()) return e;
  }
  return std::nullopt;
}

std::vector<std::vector<Answer>> revised_answers(const Room::State& state) {
  std::vector<std::vector<Answer>> revised(state.members.size());
  for (std::size_t m = 0; m < state.members.size(); ++m) {
    const auto& member = state.members[m];
    if (!state.session->has_answered(m) || !state.session->takes_part(m) || !member.seat) continue;
    revised[m] = member.revised;
    const auto& seat = state.seats[*member.seat];
    if (!seat.is_person || seat.choices.empty()) continue;
    auto answers = state.session->answers(m);
    for (std::size_t t = 0; t < seat.choices.size(); ++t) {
      if (seat.choices[t] && seat.choices[t]->entry) answers[t] = state.board[t][*seat.choices[t]->entry].path.counts;
    }
    if (answers != state.session->answers(m)) revised[m] = std::move(answers);
  }
  return revised;
}

std::vector<bool> simulated_members(const LiveStudy& study, std::size_t members) {
  const auto& people = study.group().people;
  std::vector<bool> simulated(members, !people.empty());
  for (const auto seat : people) {
    if (seat <= members) simulated[seat - 1] = false;
  }
  return simulated;
}

TeamAddress address_of(const RoomSetup& setup) {
  TeamAddress address;
  address.strategy = setup.strategy;
  address.composition = setup.composition;
  address.replicate = setup.replicate;
  return address;
}

}  // namespace kith
