#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"
#include "session_summary.hpp"

namespace kith {
namespace {

// Everything that decides what happens next. Names, messages and query parameters are left out: they may be erased.
class RoomBytes {
 public:
  explicit RoomBytes(const Room::State& state) : state_{state} {}

  std::string take() && {
    bytes_.count(state_.seq);
    bytes_.integer(state_.last_us);
    bytes_.count(static_cast<std::uint64_t>(state_.phase));
    bytes_.integer(state_.phase_us);
    for (const auto& moment : {state_.lobby_us, state_.started_us, state_.ended_us, state_.deadline_us,
                               state_.session_deadline_us, state_.paused_us}) {
      bytes_.flag(moment.has_value());
      bytes_.integer(moment.value_or(0));
    }
    bytes_.text(state_.end_reason);
    bytes_.text(state_.next_strategy ? state_.next_strategy->name : "");
    for (const auto& seat : state_.seats) add(seat);
    for (std::size_t m = 0; m < state_.members.size(); ++m) {
      const auto& member = state_.members[m];
      bytes_.count(member.seat ? *member.seat + 1 : 0);
      bytes_.flag(member.is_away);
      bytes_.flag(state_.summary ? state_.summary->has_learner[m] : member.learner != nullptr);
      add(member.response.answers);
      if (!member.revised.empty()) add(member.revised);
    }
    for (const auto& [cell, count] : state_.groups) {
      bytes_.text(cell);
      bytes_.count(count);
    }
    add_session();
    bytes_.count(state_.answers.size());
    bytes_.count(state_.notices.size());
    return std::move(bytes_).take();
  }

 private:
  void add_session() {
    if (state_.summary) {
      bytes_.text(state_.summary->digest);
      bytes_.text(state_.summary->digest_before);
      return;
    }
    bytes_.text(digest_of(*state_.session));
    bytes_.text(state_.before ? digest_of(*state_.before) : "");
  }
  void add(const std::vector<Answer>& answers) {
    bytes_.count(answers.size());
    for (const auto& answer : answers) {
      bytes_.flag(answer.has_value());
      if (answer) bytes_.vector(*answer);
    }
  }
  void add(const std::vector<std::size_t>& actions) {
    bytes_.count(actions.size());
    for (const auto action : actions) bytes_.count(action);
  }
  void add(const LiveSeat& seat) {
    bytes_.flag(seat.is_person);
    bytes_.letter(seat.type);
    bytes_.count(seat.member ? *seat.member + 1 : 0);
    bytes_.count(static_cast<std::uint64_t>(seat.status));
    bytes_.count(static_cast<std::uint64_t>(seat.readiness));
    bytes_.text(seat.last_page);
    bytes_.text(seat.why);
    for (const bool flag : {seat.gets_code, seat.is_here, seat.in_period, seat.has_answered, seat.has_continued,
                            seat.has_answered_questions}) {
      bytes_.flag(flag);
    }
    for (const auto moment : {seat.presence_us, seat.joined_us, seat.ready_us, seat.since_us}) bytes_.integer(moment);
    bytes_.count(seat.screened.size());
    for (const bool right : seat.screened) bytes_.flag(right);
    bytes_.count(seat.watched);
    bytes_.count(seat.paths.size());
    for (const auto& path : seat.paths) {
      bytes_.flag(path.has_value());
      if (!path) continue;
      add(path->actions);
      if (path->for_ever) bytes_.flag(true);  // as before where nobody can answer so
      bytes_.integer(path->ms);
    }
    add(seat.draft);
    for (const auto& choice : seat.choices) {  // none where groups do not talk
      bytes_.flag(choice.has_value());
      bytes_.count(choice && choice->entry ? *choice->entry + 1 : 0);
    }
    bytes_.count(seat.right);
    bytes_.count(seat.tests);
    if (seat.explorations > 0) bytes_.count(seat.explorations);  // as before where nobody explores
  }

  const Room::State& state_;
  ByteWriter bytes_;
};

}  // namespace

std::string Room::digest() const { return sha256(RoomBytes{*state_}.take()); }

}  // namespace kith
