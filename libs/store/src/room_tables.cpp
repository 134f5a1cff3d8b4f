#include "room_export.hpp"

#include <algorithm>
#include <utility>

#include "kith/explain/json.hpp"
#include "kith/live/screening.hpp"

namespace kith {
namespace {

struct RoomTables : RoomExport {
  void write_all() const {
    const bool is_waiting_list = setup().is_waiting_list;
    if (!is_waiting_list) write_session();
    for (const auto& [seat, row] : history.seats) {
      if (history.withdrawn.count(seat) != 0) continue;
      if (!is_waiting_list || history.stage_of(seat) != "moved") write_participant(seat, row);
    }
    for (const auto& lesson : history.lessons) {
      if (!lesson.is_replaced) write_period(lesson);
    }
    write_beliefs();
    for (const auto& event : history.events) write_event(event);
  }

  [[nodiscard]] std::optional<double> belief_in(std::size_t member) const {
    const bool is_kept = session().belief().options().members || session().num_members() == 1;
    if (!is_kept || member == 0 || member > session().num_members()) return std::nullopt;
    return session().belief().member(member - 1).mass_in(study.atlas->policy_bec_half_spaces());
  }

  void write_session() const {
    const auto& past = session().history();
    std::size_t demonstrations = 0, tests = 0, answered = 0, right = 0;
    double knowledge = 0.0;
    std::size_t known = 0;
    for (const auto& one : audits) {
      answered += one.audit.agreement.tests;
      right += one.audit.agreement.right;
      if (one.seat != history.seat_of(one.member) || !one.audit.knowledge()) continue;
      knowledge += *one.audit.knowledge();
      ++known;
    }
    for (const auto& period : past) {
      demonstrations += period.lesson.demonstrations.size();
      tests += period.lesson.tests.size();
    }
    std::size_t learned = 0;
    for (const auto status : session().components()) learned += status == ComponentStatus::kLearned ? 1u : 0u;
    const auto simulated = std::count(setup().simulated.begin(), setup().simulated.end(), true);
    const auto& events = history.events;
    const auto size = setup().composition.size();
    write.add(tables.sessions,
              {.session = id(),
               .strategy = setup().strategy,
               .composition = setup().composition,
               .replicate = setup().replicate,
               .size = size,
               .people = size - static_cast<std::size_t>(simulated),
               .withdrawn = history.withdrawn.size(),
               .created_ms = ms_of(history.stored.created_us),
               .started_ms = ms_if_any(history.started_us),
               .last_ms = ms_if_any(events.empty() ? 0 : events.back().at_us),
               .stage = std::string{name_of(history.room->stage())},
               .ended = if_any(history.ended),
               .completed = session().status() == SessionStatus::kComplete,
               .periods = past.size(),
               .demonstrations = demonstrations,
               .tests = tests,
               .share_right = share(right, answered),
               .components_learned = learned,
               .knowledge = known > 0 ? std::optional{knowledge / static_cast<double>(known)} : std::nullopt,
               .digest = history.replayed.digest});
  }

  void write_participant(std::size_t seat, const SeatRow& person) const {
    std::size_t tests = 0, right = 0;
    std::optional<double> knowledge;
    for (const auto& one : audits) {
      if (one.seat != seat || !one.audit.knowledge()) continue;
      tests += one.audit.agreement.tests;
      right += one.audit.agreement.right;
      knowledge = one.audit.knowledge();
    }
    const auto group = setup().is_waiting_list ? RoomSetup{} : setup();
    const auto stage = history.stage_of(seat);
    const bool is_last = person.member && history.seat_of(*person.member) == seat;
    const auto& screened = person.screened;
    const auto passed = static_cast<std::size_t>(std::count(screened.begin(), screened.end(), true));
    const bool is_screened = !screened.empty() && screened.size() == study.screening.size();
    ParticipantRow row{.session = id(),
                       .seat = seat,
                       .member = person.member,
                       .type = history.type_of(person.member),
                       .strategy = if_any(group.strategy),
                       .composition = if_any(group.composition),
                       .simulated = person.simulated,
                       .joined_ms = ms_if_any(person.joined_us),
                       .consent = if_any(person.consent),
                       .stage = if_any(stage),
                       .status = seat <= history.room->num_seats() ? history.room->status_of(seat) : "empty",
                       .times_away = person.times_away,
                       .seconds_away = static_cast<double>(person.away_us) / 1e6,
                       .tests = tests,
                       .right = right,
                       .share_right = share(right, tests),
                       .knowledge = knowledge,
                       .p_bec = is_last ? belief_in(*person.member) : std::nullopt,
                       .name = if_any(printable(person.name))};
    if (is_screened) row.estimate = screening_estimate(passed, screened.size());
    if (!person.query.empty()) row.query = printable(person.query.dump());
    const bool has_code = seat <= history.room->num_seats() && history.room->shows_code(seat);
    if (has_code && options.with_names) row.code = completion_code(study, setup().salt, setup().id, seat);
    write.add(tables.participants, row);
  }

  void write_period(const LessonRow& lesson_row) const {
    const auto& lesson = lesson_row.lesson;
    const auto& past = session().history();
    const auto& source = lesson.source;
    PeriodRow row{.session = id(),
                  .period = lesson.period,
                  .component = lesson.component + 1,
                  .source = source.is_member() ? "member " + std::to_string(source.member + 1) : source.rule,
                  .chosen_ms = ms_of(lesson_row.chosen_us),
                  .demonstrations = lesson.demonstrations.size(),
                  .tests = lesson.tests.size(),
                  .gain = lesson.gain,
                  .area_sr = lesson.area_sr,
                  .digest = lesson_row.digest};
    const bool is_finished = lesson.period <= past.size();
    if (is_finished) {
      const auto& feedback = past[lesson.period - 1].feedback;
      row.n_active = 0;
      row.all_right = true;
      for (std::size_t i = 0; i < feedback.verdicts.size(); ++i) {
        if (feedback.verdicts[i].empty()) continue;
        ++*row.n_active;
        row.all_right = *row.all_right && feedback.all_correct[i];
      }
    }
    write.add(tables.periods, row);
  }

  void write_beliefs() const {
    const auto detail = history.room->view({.role = Viewer::Role::kObserver, .seat = 0}, 0)["room"];
    for (const auto& point : detail["curves"]) {
      for (const auto& [name, mass] : point["p_bec"].items()) {
        constexpr std::string_view kMember{"member "};
        BeliefRow row{
            .session = id(), .period = point["period"].get<std::size_t>(), .belief = name, .p_bec = mass.get<double>()};
        if (name.compare(0, kMember.size(), kMember) == 0) row.member = std::stoul(name.substr(kMember.size()));
        if (row.member && history.is_withdrawn(row.period, *row.member)) continue;
        write.add(tables.beliefs, row);
      }
    }
  }

  void write_event(const StoredEvent& event) const {
    auto body = body_of(event);
    if (event.type == happening::Grouped::kKind.word) {
      for (auto& seat : body["seats"]) {
        if (seat.is_number() && history.withdrawn.count(seat.get<std::size_t>()) != 0) seat = nullptr;
      }
    }
    if (!options.with_names && body.is_object()) {
      const auto* kind = room_event_kind(event.type);
      for (const auto& member : kind == nullptr ? std::array<PersonalMember, 2>{} : kind->personal) {
        const bool is_words =
            member.what == PersonalMember::What::kWords || member.what == PersonalMember::What::kAnswers;
        if (!is_words) body.erase(std::string{member.name});
      }
    }
    if (!options.with_text && body.is_object()) {
      for (const auto* name : {"text", "reason"}) {
        if (event.type != happening::Ended::kKind.word || event.actor == "facilitator") body.erase(name);
      }
      if (event.type == happening::QuestionsAnswered::kKind.word && body.contains("answers")) {
        for (const auto& question : study.group().questions) {
          if (question.kind == GroupQuestion::Kind::kText) body["answers"].erase(question.id);
        }
      }
    }
    write.add(tables.events, {.session = id(),
                              .seq = event.seq,
                              .at_us = event.at_us,
                              .actor = event.actor,
                              .type = event.type,
                              .body = printable(body.dump())});
  }
};

}  // namespace

void write_room(const RoomExport& room) { RoomTables{room}.write_all(); }

}  // namespace kith
