#include "room_history.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"
#include "kith/store/json_members.hpp"

namespace kith {

using namespace happening;  // NOLINT(google-build-using-namespace): every event is named here

namespace {

class Collector {
 public:
  explicit Collector(RoomHistory& history) : history_{history} {}

  void take(const Room& room, const RoomEvent& event) {
    history_.room = room;
    taught_.see(room);
    seat_ = seat_of_actor(event.actor).value_or(0);
    is_by_facilitator_ = event.actor == "facilitator";
    at_us_ = event.at_us;
    std::visit([&](const auto& what) { note(what); }, event.what);
  }
  [[nodiscard]] std::vector<TaughtPerson> people() const {
    const auto& room = *history_.room;
    if (room.setup().is_waiting_list || room.session().history().empty()) return {};
    return taught_.all(room);
  }

 private:
  void note(const Joined& e) { begin(e); }
  void note(const Consented& e) { note_consent(history_.seats[seat_], e); }
  void note(const Screened& e) { history_.seats[seat_].screened.push_back(e.right); }
  void note(const Seated& e) {
    auto& row = begin(e);
    row.name = e.name;
    row.screened = e.screened;
    note_consent(row, e);
  }
  void note(const Named& e) { history_.seats[seat_].name = e.name; }
  void note(const Started&) {
    history_.started_us = at_us_;
    note_stand_ins();
  }
  void note(const Ended& e) { history_.ended = is_by_facilitator_ ? "facilitator" : e.reason; }
  void note(const Away& e) { note_presence(history_.seats[e.seat], true); }
  void note(const Present& e) { note_presence(history_.seats[e.seat], false); }
  void note(const Dropped& e) { replace(e.seat, e.by.value_or(0)); }
  void note(const Simulated& e) { replace(e.seat, e.by); }
  void note(const Left& e) { replace(seat_, e.by.value_or(0)); }
  void note(const LessonChosen& e) { note_lesson(e); }
  void note(const Answered& e) { note_answer(e); }
  void note(const QuestionsAnswered& e) {
    if (e.answers.is_object()) history_.seats[seat_].answers = e.answers;
  }
  // Tables say nothing of these.
  void note(const Declined&) {}
  void note(const Checked&) {}
  void note(const Watched&) {}
  void note(const Drafted&) {}
  void note(const Continued&) {}
  void note(const Explored&) {}
  void note(const Examined& e) { history_.seats[seat_].examined.push_back({e, at_us_}); }
  void note(const Discussed&) {}
  void note(const Released&) {}
  void note(const Grouped&) {}
  void note(const TimeOver&) {}
  void note(const Paused&) {}
  void note(const Resumed&) {}
  void note(const Extended&) {}
  void note(const MessageSent&) {}
  void note(const Readmitted&) {}
  void note(const StrategyNamed&) {}

  // Somebody has a place, or is on the waiting list.
  template <typename Event>
  SeatRow& begin(const Event& e) {
    auto& row = history_.seats[e.seat];
    row.joined_us = at_us_;
    if (const std::optional<std::size_t> member = e.member) row.member = *member + 1;
    return row;
  }

  template <typename Event>
  static void note_consent(SeatRow& row, const Event& e) {
    row.consent = e.version;
    if (e.query.is_object()) row.query = e.query;
  }

  void note_presence(SeatRow& row, bool is_away) const {
    if (is_away && row.away_since_us == 0) {
      ++row.times_away;
      row.away_since_us = at_us_;
    } else if (!is_away && row.away_since_us != 0) {
      row.away_us += at_us_ - std::exchange(row.away_since_us, 0);
    }
  }

  // Those who fill the places of people who did not come.
  void note_stand_ins() {
    const auto shown = history_.room->row({.role = Viewer::Role::kObserver, .seat = 0});
    for (const auto& seat : shown.at("seats")) {
      const auto number = count_at(seat, "seat");
      if (text_at(seat, "kind") != "simulated" || history_.seats.count(number) != 0) continue;
      auto& row = history_.seats[number];
      row.member = seat.contains("member") ? count_at(seat, "member") : number;
      row.simulated = true;
      row.joined_us = at_us_;
    }
  }

  void replace(std::size_t seat, std::size_t by) {
    if (by == 0) return;
    auto& row = history_.seats[by];
    row.member = history_.seats[seat].member;
    row.joined_us = at_us_;
    row.simulated = true;
  }

  void note_lesson(const LessonChosen& e) {
    if (e.finished) return;
    const auto& session = history_.room->session();
    const auto period = e.period;
    // Somebody came or went before that lesson was taught, or all who had watched it are gone.
    if (!history_.lessons.empty() && history_.lessons.back().lesson.period == period)
      history_.lessons.back().is_replaced = true;
    // A room without people is done with the lesson at once.
    const bool is_over = session.periods() >= period;
    history_.lessons.push_back({.lesson = is_over ? session.history()[period - 1].lesson : session.lesson(),
                                .chosen_us = at_us_,
                                .digest = e.digest});
  }

  void note_answer(const Answered& e) {
    if (history_.lessons.empty()) return;  // not in a history that replays
    AnswerRow row;
    row.lesson = history_.lessons.size() - 1;
    row.period = history_.lessons.back().lesson.period;
    row.test = e.test;
    row.seat = seat_;
    row.member = history_.seats[seat_].member.value_or(0);
    row.actions = e.actions;
    row.for_ever = e.for_ever;
    row.keys = e.keys;
    row.ms = e.ms;
    row.at_us = at_us_;
    history_.answers.push_back(std::move(row));
  }

  RoomHistory& history_;
  TaughtPeople taught_;
  std::size_t seat_ = 0;  // of the actor of the event
  bool is_by_facilitator_ = false;
  std::int64_t at_us_ = 0;
};

}  // namespace

const LessonRow* RoomHistory::lesson_of(std::size_t period) const {
  for (const auto& row : lessons) {
    if (row.lesson.period == period && !row.is_replaced) return &row;
  }
  return nullptr;
}

std::size_t RoomHistory::seat_of(std::size_t member) const {
  std::size_t last = 0;
  for (const auto& [seat, row] : seats) {
    if (row.member == member) last = seat;
  }
  return last;
}

const TaughtPerson* RoomHistory::person_in(std::size_t period, std::size_t member) const {
  for (const auto& person : people) {
    const auto has_it = [&](const ObservedPeriod& one) { return one.period == period; };
    if (person.member + 1 == member && std::any_of(person.periods.begin(), person.periods.end(), has_it)) {
      return &person;
    }
  }
  return nullptr;
}

std::string RoomHistory::stage_of(std::size_t seat) const {
  return seat <= room->num_seats() ? room->stage_of(seat) : std::string{};
}

std::optional<std::string> RoomHistory::type_of(std::optional<std::size_t> member) const {
  const auto& letters = room->setup().composition;
  if (!member || *member == 0 || *member > letters.size()) return std::nullopt;
  return std::string{letters[*member - 1]};
}

const Verdict* RoomHistory::verdict(std::size_t period, std::size_t member, std::size_t test) const {
  const auto& past = room->session().history();
  if (period == 0 || period > past.size() || member == 0) return nullptr;
  const auto& verdicts = past[period - 1].feedback.verdicts;
  if (member > verdicts.size() || test >= verdicts[member - 1].size()) return nullptr;
  return &verdicts[member - 1][test];
}

RoomHistory read_history(EventFile& file, const StoredRoom& stored, const std::shared_ptr<const LiveStudy>& study,
                         TeachingCache& cache) {
  RoomHistory history;
  history.stored = stored;
  Room fresh{study, room_setup(Json::parse(stored.setup)), cache};
  for (std::size_t seat = 1; seat <= fresh.num_seats(); ++seat) {
    if (fresh.is_person(seat)) continue;
    history.seats[seat].member = seat;
    history.seats[seat].simulated = true;
  }
  history.room = std::move(fresh);
  Collector collector{history};
  history.replayed = replay_room(file, stored, study, cache,
                                 [&](const Room& room, const RoomEvent& event) { collector.take(room, event); });
  if (!history.replayed.problem.empty()) {
    refuse_run(ErrorKind::kMismatch, "E1614", file.path(),
               "room " + history.replayed.id + " does not replay to what it was: " + history.replayed.problem,
               "use the version of kith and the kind of machine that the session was run with");
  }
  history.people = collector.people();
  file.for_each_event([&](const StoredEvent& event) { history.events.push_back(event); }, stored.number);
  for (const auto& [room, seat] : withdrawn_seats(file)) {
    if (room == stored.number) history.withdrawn.insert(seat);
  }
  std::erase_if(history.events, [&](const StoredEvent& event) {
    return history.withdrawn.count(seat_of_actor(event.actor).value_or(0)) != 0 ||
           history.withdrawn.count(count_at(body_of(event), "seat")) != 0;
  });
  const auto last = history.events.empty() ? 0 : history.events.back().at_us;
  for (auto& [seat, row] : history.seats) {
    if (row.away_since_us != 0) row.away_us += last - row.away_since_us;
  }
  return history;
}

}  // namespace kith
