#include "export_tables.hpp"

#include "kith/files/column_names.hpp"
#include "kith/study/record_columns.hpp"

namespace kith {

namespace {

using namespace columns;  // NOLINT(google-build-using-namespace): what every table is made of

constexpr auto* kMilliseconds = "ms since 1970";
constexpr auto kSessionWords = identifier(kSession, "Id of the room, unique in this export.");
constexpr auto kSeatWords = identifier(kSeat, "Number of the person or stand-in in the room, from 1.");
constexpr auto kMemberWords = identifier(kMember, "Place in the group, from 1.");
constexpr ColumnWords kPeriodWords{kPeriod, "Interaction period, from 1."};
constexpr ColumnWords kTestWords{kTest, "Test within the period, from 1."};
constexpr ColumnWords kComponentWords{kTaughtComponent, "What was taught, from 1."};

void declare(TableOf<SessionRow>& table) {
  using R = SessionRow;
  table.column(&R::session, kSessionWords)
      .column(&R::strategy, {kStrategy, "Strategy that the room was made with."})
      .column(&R::composition, {kComposition, "Types of the members, one letter each."})
      .column(&R::replicate, {kReplicate, "Number of the room among those of the same strategy and composition."})
      .column(&R::size, count("size", "Members of the group."))
      .column(&R::people, count(kPeople, "Members who were people, not stand-ins."))
      .column(&R::withdrawn,
              count("withdrawn", "People whose data were erased at their wish: no table has rows or figures of them."))
      .column(&R::created_ms, {"created_ms", "When the room was made.", kMilliseconds})
      .column(&R::started_ms, {kStartedMs, "When teaching began; missing if it never did.", kMilliseconds})
      .column(&R::last_ms, {"last_ms", "When anything happened last; missing if nothing did.", kMilliseconds})
      .column(&R::stage, {"stage", "How the room stood at the end of the export: lobby, running, questions or ended."})
      .column(&R::ended, {kEnded, "Why the session ended before its time; missing if it did not."})
      .column(&R::completed,
              {kCompleted, "Whether every component was learned, implied by others or left out by design."})
      .column(&R::periods, count(kPeriods, "Completed interaction periods."))
      .column(&R::demonstrations, count(kDemonstrations, "Demonstrations shown in completed periods."))
      .column(&R::tests, count(kTests, "Tests asked in completed periods, per member."))
      .column(&R::share_right,
              {kShareRight, "Share of the tests of completed periods that were answered rightly.", "share"})
      .column(&R::components_learned, count("components_learned", "Components that everybody learned."))
      .column(&R::knowledge, {kKnowledge,
                              "Mean over members of what they know in the end, see participants.csv; missing if nobody "
                              "had a lesson.",
                              "share"})
      .column(&R::digest, {"digest", "Digest of the room's final state, equal whenever the room is replayed."});
}

void declare(TableOf<ParticipantRow>& table, const SessionExportOptions& options) {
  using R = ParticipantRow;
  table.column(&R::session, identifier(kSession, "Id of the room; missing for people who found no seat."))
      .column(&R::seat, identifier(kSeat, "Number of the person or stand-in in the room, from 1; 0: no seat."))
      .column(&R::member, identifier(kMember, "Place in the group, from 1; missing for people on a waiting list."))
      .column(&R::type, {kType, "Letter of the learner type of that place."})
      .column(&R::strategy, {kStrategy, "Strategy of the room; missing for people who stayed on the waiting list."})
      .column(&R::composition, {kComposition, "Types of the members of the room; missing like the strategy."})
      .column(&R::simulated, {kSimulated, "Whether this is a simulated stand-in."})
      .column(&R::joined_ms, {"joined_ms", "When the person took the seat.", kMilliseconds})
      .column(&R::consent, {"consent", "Version of the consent text that was agreed to."})
      .column(&R::stage, {"stage", "Last page that the person saw; missing for stand-ins."})
      .column(&R::status, {"status",
                           "empty (nobody came), active, finished, left, dropped (was away for too long), replaced, "
                           "withdrawn, ended (with the room, before its time), declined, full, or simulated."})
      .column(&R::times_away, count("times_away", "How often the connection was lost for more than 10 s."))
      .column(&R::seconds_away, {"seconds_away", "How long in total.", "s"})
      .column(&R::tests, count(kTests, "Tests asked in completed periods, those not answered in time included."))
      .column(&R::right, count(kRight, "Of them, answered rightly."))
      .column(&R::share_right, {kShareRight, "right / tests; missing without tests.", "share"})
      .column(&R::knowledge, {kKnowledge,
                              "How often the person is expected to get all of a component right, as a mean over the "
                              "components that they were taught: what 'kith audit' says of their answers.",
                              "share"})
      .column(&R::p_bec, {kBelief, "The teacher's final belief that the member knows the robot's policy.", "share"})
      .column(&R::estimate, {"estimate",
                             "Estimate of ability from the screening, the expected share of right answers; missing "
                             "without a finished screening.",
                             "share"});
  if (!options.with_names) return;
  table.column(&R::name, {"name", "Name that the person gave."})
      .column(&R::query, {"query", "Parameters of the recruitment platform, as JSON."})
      .column(&R::code, {"code", "Completion code that the person was shown."});
}

void declare(TableOf<PeriodRow>& table) {
  using R = PeriodRow;
  table.column(&R::session, kSessionWords)
      .column(&R::period, kPeriodWords)
      .column(&R::component, kComponentWords)
      .column(&R::source, {"source", "Whose belief the lesson was chosen for: common, joint, everybody, or member N."})
      .column(&R::chosen_ms, {"chosen_ms", "When the teacher had chosen the lesson.", kMilliseconds})
      .column(&R::demonstrations, count(kDemonstrations, "Demonstrations shown."))
      .column(&R::tests, count(kTests, "Tests asked."))
      .column(&R::n_active, count(kActive, "Members who took part in the tests."))
      .column(&R::all_right,
              {"all_right", "Whether all of them answered all tests rightly; missing if the period was not finished."})
      .column(&R::gain, {"gain", "log(area of the taught region before / after the lesson).", "nat"})
      .column(&R::area_sr, {kAreaSr, "Solid angle of what the lesson teaches.", "sr"})
      .column(&R::digest, {"digest", "Digest of lesson and beliefs, compared in every replay."});
}

void declare(TableOf<TestRow>& table, const SessionExportOptions& options) {
  using R = TestRow;
  table.column(&R::session, kSessionWords)
      .column(&R::period, kPeriodWords)
      .column(&R::component, kComponentWords)
      .column(&R::test, kTestWords)
      .column(&R::seat, kSeatWords)
      .column(&R::member, kMemberWords)
      .column(&R::type, {kType, "Letter of the learner type."})
      .column(&R::strategy, {kStrategy, "Strategy of the room."})
      .column(&R::mdp, {kMdp, "Number of the world."});
  if (options.with_world_names) table.column(&R::mdp_name, kOfWorld);
  table.column(&R::start, {kStart, "State in which the test begins."})
      .column(&R::path, {"path",
                         "Names of the actions of the answer, separated by blanks; ... behind them if they go on like "
                         "this for ever."})
      .column(&R::actions, count("actions", "Their number."))
      .column(&R::correct,
              {kCorrect, "Whether the path is as good as the robot's; missing if the period was not finished."})
      .column(&R::regret, {kRegret,
                           "Return of the robot's path minus that of the answer; missing if the person stopped short "
                           "of the end.",
                           kRewardUnit})
      .column(&R::rt, {"rt", "Time from the test appearing to submitting, as the browser measured it.", "s"})
      .column(&R::at_ms, {"at_ms", "When the answer was saved.", kMilliseconds});
}

void declare(TableOf<DiscussionRow>& table) {
  using R = DiscussionRow;
  table.column(&R::session, kSessionWords)
      .column(&R::period, kPeriodWords)
      .column(&R::component, kComponentWords)
      .column(&R::test, kTestWords)
      .column(&R::seat, identifier(kSeat, "Number of the person in the room, from 1; missing for stand-ins."))
      .column(&R::member, kMemberWords)
      .column(&R::correct, {kCorrect, "Whether the first answer is as good as the robot's path."})
      .column(&R::revised_correct, {"revised_correct", "Whether the answer after the discussion is."})
      .column(&R::changed, {"changed", "Whether that is another answer."});
}

void declare(TableOf<ExamRow>& table) {
  using R = ExamRow;
  table.column(&R::session, kSessionWords)
      .column(&R::seat, identifier(kSeat, "Number of the person in the room, from 1."))
      .column(&R::member, kMemberWords)
      .column(&R::type, {kType, "Letter of the learner type of that place."})
      .column(&R::role, {"role", "What people of this type are called; missing if they have no label."})
      .column(&R::date, {"date", "Day of the last answer, in UTC."})
      .column(&R::at_ms, {"at_ms", "When the last answer was saved.", kMilliseconds})
      .column(&R::robot, {"robot", "SHA-256 of the domain file: which robot this was about."})
      .column(&R::component, kComponentWords)
      .column(&R::boards, count("boards", "Boards that were asked in the whole exam."))
      .column(&R::asked, {"asked", "World and state in which each of them begins, as world:state."})
      .column(&R::answers, {"answers", "1 for every answer that is as good as the robot's path, else 0."})
      .column(&R::result, {"result", "understands, does-not-understand or cannot-tell: this component."})
      .column(&R::all, {"all", "The same of all components together."});
}

}  // namespace

ExportTables::ExportTables(const SessionExportOptions& options)
    : questions{"questions.csv", options.with_text ? "One answer to one question at the end."
                                                   : "One answer to one question at the end; free text is left out."} {
  declare(sessions);
  declare(participants, options);
  declare(periods);
  declare(tests, options);
  declare(discussions);
  declare(exams);

  keys.column(&KeyRow::session, kSessionWords)
      .column(&KeyRow::period, kPeriodWords)
      .column(&KeyRow::test, kTestWords)
      .column(&KeyRow::seat, kSeatWords)
      .column(&KeyRow::key, {"key", "Place in the answer, from 1."})
      .column(&KeyRow::action, {"action", "Name of the action, undo or reset."})
      .column(&KeyRow::ms, {"ms", "Since the test appeared, as the browser measured it.", "ms"});

  questions.column(&QuestionRow::session, kSessionWords)
      .column(&QuestionRow::seat, kSeatWords)
      .column(&QuestionRow::question, identifier("question", "Id of the question."))
      .column(&QuestionRow::kind, {"kind", "likert, choice or text."})
      .column(&QuestionRow::value, {"value", "The answer; missing for free text unless it was asked for."});

  trials.column(&TrialRow::user_id, identifier("user_id", "Seat of the person."))
      .column(&TrialRow::group, identifier("group", "Id of the room."))
      .column(&TrialRow::domain, {"domain", "Id of the domain."})
      .column([](const TrialRow&) { return "cl"; }, {"loop_condition", "cl: closed loop."})
      .column(&TrialRow::kc_id, {"kc_id", "Component, from 1."})
      .column(&TrialRow::interaction_type, {"interaction_type", "demo, diagnostic test or diagnostic feedback."})
      .column(&TrialRow::is_opt_response, {"is_opt_response", "1 or 0 for tests."})
      .column(&TrialRow::mdp_parameters,
              {"mdp_parameters",
               "JSON with the constraints and the prior, what people know beforehand, normals of half-spaces."});

  beliefs.column(&BeliefRow::session, kSessionWords)
      .column(&BeliefRow::period, kPeriodWords)
      .column(&BeliefRow::belief,
              {"belief", "Whom the belief is about: member N, or how beliefs were combined, such as common."})
      .column(&BeliefRow::member, identifier(kMember, "Place in the group, from 1; missing for combined beliefs."))
      .column(&BeliefRow::p_bec, {kBelief,
                                  "Share of the belief in the set of rewards that lead to the robot's policy: the "
                                  "teacher's estimate of what the member knows.",
                                  "share"});

  events.column(&EventRow::session, kSessionWords)
      .column(&EventRow::seq, {"seq", "Number within the room, from 1."})
      .column(&EventRow::at_us, {"at_us", "When it happened.", "us since 1970"})
      .column(&EventRow::actor, {"actor", "seat:N, facilitator or server."})
      .column(&EventRow::type, {kType, "What happened."})
      .column(&EventRow::body,
              {"body", "The rest, as JSON; what identifies people and free text are left out unless asked for."});
}

std::vector<TableDescription> export_tables(const SessionExportOptions& options) {
  const ExportTables all{options};
  std::vector tables{all.sessions.description(), all.participants.description(), all.periods.description(),
                     all.tests.description(),    all.keys.description(),         all.questions.description(),
                     all.trials.description(),   all.beliefs.description(),      all.events.description()};
  if (options.with_discussions) tables.push_back(all.discussions.description());
  if (options.with_exams) tables.push_back(all.exams.description());
  return tables;
}

}  // namespace kith
