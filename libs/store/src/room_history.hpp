#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kith/live/taught_people.hpp"
#include "kith/store/event_file.hpp"
#include "kith/store/session_review.hpp"

// What happened in one room, collected while it is replayed.
namespace kith {

struct AnswerRow {
  std::size_t lesson = 0;  // index into RoomHistory::lessons
  std::size_t period = 0;
  std::size_t test = 0;  // from 0
  std::size_t seat = 0;
  std::size_t member = 0;  // from 1
  std::vector<std::size_t> actions;
  bool for_ever = false;
  Json keys;  // [[action | "undo" | "reset", ms], ...]
  std::optional<std::int64_t> ms;
  std::int64_t at_us = 0;
};

struct SeatRow {
  std::optional<std::size_t> member;  // from 1
  bool simulated = false;
  std::int64_t joined_us = 0;
  std::string consent;
  std::vector<std::pair<happening::Examined, std::int64_t>> examined;  // with the time in microseconds
  std::vector<bool> screened;                                          // whether each answer to the screening was right
  std::string name;
  Json query = Json::object();
  Json answers = Json::object();  // to the questions
  std::size_t times_away = 0;
  std::int64_t away_since_us = 0;  // 0: here
  std::int64_t away_us = 0;
};

struct LessonRow {
  Lesson lesson;
  std::int64_t chosen_us = 0;
  std::string digest;
  bool is_replaced = false;  // another one was chosen for the same period
};

struct RoomHistory {
  StoredRoom stored;
  ReplayedRoom replayed;
  std::optional<Room> room;  // at the end
  std::map<std::size_t, SeatRow> seats;
  std::vector<LessonRow> lessons;
  std::vector<AnswerRow> answers;
  std::vector<TaughtPerson> people;  // who took part in which periods; nobody on a waiting list
  std::vector<StoredEvent> events;   // none of or about people whose data were erased
  std::int64_t started_us = 0;
  std::string ended;
  std::set<std::size_t> withdrawn;  // seats of people whose data were erased

  // The lesson that was taught in a period; null if there is none.
  [[nodiscard]] const LessonRow* lesson_of(std::size_t period) const;
  // The seat that a member's place belongs to last; 0: none.
  [[nodiscard]] std::size_t seat_of(std::size_t member) const;
  // Who took part for a member in a finished period; null: nobody.
  [[nodiscard]] const TaughtPerson* person_in(std::size_t period, std::size_t member) const;
  // What a seat is shown at the end, see Room::stage_of().
  [[nodiscard]] std::string stage_of(std::size_t seat) const;
  // The letter of a member's type; none without a member.
  [[nodiscard]] std::optional<std::string> type_of(std::optional<std::size_t> member) const;
  // Whether a member's place was that of somebody who was withdrawn, in a period.
  [[nodiscard]] bool is_withdrawn(std::size_t period, std::size_t member) const {
    const auto* person = person_in(period, member);
    return withdrawn.count(person == nullptr ? seat_of(member) : person->seat) != 0;
  }
  // Whether another lesson was taught in place of the one that the answer belongs to.
  [[nodiscard]] bool is_void(const AnswerRow& answer) const { return lessons[answer.lesson].is_replaced; }
  // The verdict on an answer, if the period was finished and the member took part.
  [[nodiscard]] const Verdict* verdict(std::size_t period, std::size_t member, std::size_t test) const;
};

// Replays a room and collects. @throws kith::Error kMismatch E1614 if it does not replay to what it was.
[[nodiscard]] RoomHistory read_history(EventFile& file, const StoredRoom& stored,
                                       const std::shared_ptr<const LiveStudy>& study, TeachingCache& cache);

}  // namespace kith
