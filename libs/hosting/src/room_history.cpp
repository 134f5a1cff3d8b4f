#include "room_history.hpp"

#include <algorithm>
#include <utility>

#include "json_members.hpp"
#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"

namespace kith {
namespace {

class Collector {
 public:
  explicit Collector(RoomHistory& history) : history_{history} {}

  void take(const Room& room, const RoomEvent& event) {
    const auto& body = event.body;
    const auto by = seat_of_actor(event.actor);
    const auto seat = by ? *by : count_at(body, "seat");
    history_.room = room;
    if (event.type == "joined") {
      auto& row = history_.seats[count_at(body, "seat")];
      row.joined_us = event.at_us;
      note_member(row, body);
    } else if (event.type == "consented") {
      note_consent(history_.seats[seat], body);
    } else if (event.type == "screened") {
      history_.seats[seat].screened.push_back(body.value("right", false));
    } else if (event.type == "seated") {
      auto& row = history_.seats[seat];
      row.joined_us = event.at_us;
      note_member(row, body);
      row.name = text_at(body, "name");
      row.screened = body.value("screened", std::vector<bool>{});
      note_consent(row, body);
    } else if (event.type == "named") {
      history_.seats[seat].name = text_at(body, "name");
    } else if (event.type == "started") {
      history_.started_us = event.at_us;
      note_stand_ins(room, event.at_us);
    } else if (event.type == "ended") {
      history_.ended = text_at(body, "reason");
    } else if (event.type == "away" || event.type == "present") {
      note_presence(history_.seats[seat], event.type == "away", event.at_us);
    } else if (event.type == "dropped" || event.type == "simulate" || event.type == "left") {
      replace(seat, count_at(body, "by"), event.at_us);
    } else if (event.type == "lesson") {
      note_lesson(room, event);
    } else if (event.type == "answered") {
      note_answer(seat, event);
    } else if (event.type == "questions") {
      if (const auto answers = body.find("answers"); answers != body.end() && answers->is_object())
        history_.seats[seat].answers = *answers;
    }
  }

 private:
  // Counted from 0 in events; null for whoever waits in reserve or takes a place over with the next event.
  static void note_member(SeatRow& row, const Json& body) {
    const auto member = body.find("member");
    if (member != body.end() && member->is_number_unsigned()) row.member = member->get<std::size_t>() + 1;
  }

  static void note_consent(SeatRow& row, const Json& body) {
    row.consent = text_at(body, "version");
    if (const auto query = body.find("query"); query != body.end() && query->is_object()) row.query = *query;
  }

  static void note_presence(SeatRow& row, bool is_away, std::int64_t at_us) {
    if (is_away && row.away_since_us == 0) {
      ++row.times_away;
      row.away_since_us = at_us;
    } else if (!is_away && row.away_since_us != 0) {
      row.away_us += at_us - std::exchange(row.away_since_us, 0);
    }
  }

  // Those who fill the places of people who did not come.
  void note_stand_ins(const Room& room, std::int64_t at_us) {
    const auto shown = room.row({.role = Viewer::Role::kObserver, .seat = 0});
    for (const auto& seat : shown.at("seats")) {
      const auto number = count_at(seat, "seat");
      if (text_at(seat, "kind") != "simulated" || history_.seats.count(number) != 0) continue;
      auto& row = history_.seats[number];
      row.member = seat.contains("member") ? count_at(seat, "member") : number;
      row.simulated = true;
      row.joined_us = at_us;
    }
  }

  void replace(std::size_t seat, std::size_t by, std::int64_t at_us) {
    if (by == 0) return;
    auto& row = history_.seats[by];
    row.member = history_.seats[seat].member;
    if (row.joined_us != 0) return;
    row.joined_us = at_us;
    row.simulated = true;
  }

  void note_lesson(const Room& room, const RoomEvent& event) {
    if (event.body.value("finished", false)) return;
    const auto& session = room.session();
    const auto period = count_at(event.body, "period");
    // Somebody came or went before that lesson was taught, or all who had watched it are gone.
    if (!history_.lessons.empty() && history_.lessons.back().lesson.period == period)
      history_.lessons.back().is_replaced = true;
    // A room without people is done with the lesson at once.
    const bool is_over = session.periods() >= period;
    history_.lessons.push_back({.lesson = is_over ? session.history()[period - 1].lesson : session.lesson(),
                                .chosen_us = event.at_us,
                                .digest = text_at(event.body, "digest")});
  }

  void note_answer(std::size_t seat, const RoomEvent& event) {
    if (history_.lessons.empty()) return;  // not in a history that replays
    AnswerRow row;
    row.lesson = history_.lessons.size() - 1;
    row.period = history_.lessons.back().lesson.period;
    row.test = count_at(event.body, "test");
    row.seat = seat;
    row.member = history_.seats[seat].member.value_or(0);
    if (const auto actions = event.body.find("actions"); actions != event.body.end() && actions->is_array()) {
      for (const auto& action : *actions) {
        if (action.is_number_unsigned()) row.actions.push_back(action.get<std::size_t>());
      }
    }
    const auto for_ever = event.body.find("for_ever");
    row.for_ever = for_ever != event.body.end() && *for_ever == true;
    if (const auto keys = event.body.find("keys"); keys != event.body.end()) row.keys = *keys;
    if (const auto ms = event.body.find("ms"); ms != event.body.end() && ms->is_number_integer())
      row.ms = ms->get<std::int64_t>();
    row.at_us = event.at_us;
    history_.answers.push_back(std::move(row));
  }

  RoomHistory& history_;
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
  file.for_each_event([&](const StoredEvent& event) { history.events.push_back(event); }, stored.number);
  const auto last = history.events.empty() ? 0 : history.events.back().at_us;
  for (auto& [seat, row] : history.seats) {
    if (row.away_since_us != 0) row.away_us += last - row.away_since_us;
  }
  return history;
}

}  // namespace kith
