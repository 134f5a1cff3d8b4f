#include "export_tables.hpp"

namespace kith {
namespace {

Column text(const char* name, const char* description, bool required = true) {
  return {.name = name, .type = ColumnType::kText, .description = description, .required = required};
}
Column identifier(const char* name, const char* description) {
  auto column = text(name, description);
  column.kind = ColumnKind::kIdentifier;
  return column;
}
Column integer(const char* name, const char* description, bool required = true, const char* unit = "") {
  return {.name = name, .type = ColumnType::kInteger, .description = description, .unit = unit, .required = required};
}
Column count(const char* name, const char* description, bool required = true) {
  auto column = integer(name, description, required);
  column.kind = ColumnKind::kCount;
  return column;
}
Column real(const char* name, const char* description, bool required = true, const char* unit = "") {
  return {.name = name, .type = ColumnType::kReal, .description = description, .unit = unit, .required = required};
}
Column boolean(const char* name, const char* description, bool required = true) {
  return {.name = name, .type = ColumnType::kBoolean, .description = description, .required = required};
}

Column session_column() { return identifier("session", "Id of the room, unique in this export."); }
Column seat_column() { return integer("seat", "Number of the person or stand-in in the room, from 1."); }
Column period_column() { return integer("period", "Interaction period, from 1."); }

}  // namespace

TableDescription sessions_table() {
  return {
      .file = kSessionsFile,
      .description = "One room: a group that was taught together.",
      .columns = {session_column(), text("strategy", "Strategy that the room was made with."),
                  text("composition", "Types of the members, one letter each."),
                  integer("replicate", "Number of the room among those of the same strategy and composition."),
                  count("size", "Members of the group."), count("people", "Members who were people, not stand-ins."),
                  integer("created_ms", "When the room was made.", true, "ms since 1970"),
                  integer("started_ms", "When teaching began; missing if it never did.", false, "ms since 1970"),
                  integer("last_ms", "When anything happened last; missing if nothing did.", false, "ms since 1970"),
                  text("stage", "How the room stood at the end of the export: lobby, running, questions or ended."),
                  text("ended", "Why the session ended before its time; missing if it did not.", false),
                  boolean("completed", "Whether every component was learned, implied by others or left out by design."),
                  count("periods", "Completed interaction periods."),
                  count("demonstrations", "Demonstrations shown in completed periods."),
                  count("tests", "Tests asked in completed periods, per member."),
                  real("share_right", "Share of answered tests of completed periods that were right.", false),
                  count("components_learned", "Components that everybody learned."),
                  real("knowledge",
                       "Mean over members of the teacher's belief that a member knows the robot's policy; "
                       "missing if the strategy does not use beliefs about members.",
                       false),
                  text("digest", "Digest of the room's final state, equal whenever the room is replayed.")}};
}

TableDescription participants_table(const SessionExportOptions& options) {
  TableDescription table{
      .file = kParticipantsFile,
      .description = "One person or stand-in in a room.",
      .columns = {session_column(), seat_column(),
                  integer("member", "Place in the group, from 1; missing for people who waited in reserve.", false),
                  text("type", "Letter of the learner type of that place.", false),
                  text("strategy", "Strategy of the room; missing for people who stayed on the waiting list.", false),
                  text("composition", "Types of the members of the room; missing like the strategy.", false),
                  boolean("simulated", "Whether this is a simulated stand-in."),
                  integer("joined_ms", "When the person took the seat.", false, "ms since 1970"),
                  text("consent", "Version of the consent text that was agreed to.", false),
                  text("stage", "Last page that the person saw; missing for stand-ins.", false),
                  count("times_away", "How often the connection was lost for more than 10 s."),
                  real("seconds_away", "How long in total.", true, "s"),
                  count("tests", "Tests answered in completed periods."), count("right", "Of them, answered rightly."),
                  real("share_right", "right / tests; missing without tests.", false),
                  real("p_bec", "The teacher's final belief that the member knows the robot's policy.", false),
                  real("estimate",
                       "Estimate of ability from the screening, the expected share of right answers; missing without a "
                       "finished screening.",
                       false)}};
  if (options.with_names) {
    table.columns.push_back(text("name", "Name that the person gave.", false));
    table.columns.push_back(text("query", "Parameters of the recruitment platform, as JSON.", false));
    table.columns.push_back(text("code", "Completion code that the person was shown.", false));
  }
  return table;
}

TableDescription periods_table() {
  return {.file = kPeriodsFile,
          .description = "One interaction period of a room: a lesson with its tests.",
          .columns = {session_column(), period_column(), integer("component", "What was taught, from 1."),
                      text("source", "Whose belief the lesson was chosen for: common, joint, or member N."),
                      integer("chosen_ms", "When the teacher had chosen the lesson.", true, "ms since 1970"),
                      count("demonstrations", "Demonstrations shown."), count("tests", "Tests asked."),
                      count("n_active", "Members who took part in the tests.", false),
                      boolean("all_right",
                              "Whether all of them answered all tests rightly; missing if the period was not "
                              "finished.",
                              false),
                      real("gain", "log(area of the taught region before / after the lesson)."),
                      real("area_sr", "Solid angle of what the lesson teaches.", true, "sr"),
                      text("digest", "Digest of lesson and beliefs, compared in every replay.")}};
}

TableDescription tests_table() {
  return {.file = kTestsFile,
          .description = "One answer of a person to one test.",
          .columns = {session_column(), period_column(), integer("component", "What was taught, from 1."),
                      integer("test", "Test within the period, from 1."), seat_column(),
                      integer("member", "Place in the group, from 1."), text("type", "Letter of the learner type."),
                      text("strategy", "Strategy of the room."), integer("mdp", "Number of the world."),
                      integer("start", "State in which the test begins."),
                      text("path",
                           "Names of the actions of the answer, separated by blanks; ... behind them if they go on "
                           "like this for ever.",
                           false),
                      count("actions", "Their number."),
                      boolean("correct",
                              "Whether the path is as good as the robot's; missing if the period was not "
                              "finished.",
                              false),
                      real("regret",
                           "Return of the robot's path minus that of the answer; missing if the person stopped "
                           "short of the end.",
                           false),
                      real("rt", "Time from the test appearing to submitting, as the browser measured it.", false, "s"),
                      integer("at_ms", "When the answer was saved.", true, "ms since 1970")}};
}

TableDescription discussions_table() {
  return {.file = kDiscussionsFile,
          .description = "One answer before and after the group saw all answers, of people and of stand-ins.",
          .columns = {session_column(), period_column(), integer("component", "What was taught, from 1."),
                      integer("test", "Test within the period, from 1."),
                      integer("seat", "Number of the person in the room, from 1; missing for stand-ins.", false),
                      integer("member", "Place in the group, from 1."),
                      boolean("correct", "Whether the first answer is as good as the robot's path."),
                      boolean("revised_correct", "Whether the answer after the discussion is."),
                      boolean("changed", "Whether that is another answer.")}};
}

TableDescription keys_table() {
  return {
      .file = kKeysFile,
      .description = "One keypress, click or tap of an answer.",
      .columns = {session_column(), period_column(), integer("test", "Test within the period, from 1."), seat_column(),
                  integer("key", "Place in the answer, from 1."), text("action", "Name of the action, undo or reset."),
                  integer("ms", "Since the test appeared, as the browser measured it.", true, "ms")}};
}

TableDescription questions_table(const SessionExportOptions& options) {
  return {.file = kQuestionsFile,
          .description = options.with_text ? "One answer to one question at the end."
                                           : "One answer to one question at the end; free text is left out.",
          .columns = {session_column(), seat_column(), identifier("question", "Id of the question."),
                      text("kind", "likert, choice or text."),
                      text("value", "The answer; missing for free text unless it was asked for.", false)}};
}

TableDescription trials_table() {
  return {.file = kTrialsFile,
          .description = "One demonstration, test or feedback of one person, in order, for 'kith fit'.",
          .columns = {identifier("user_id", "Seat of the person."), identifier("group", "Id of the room."),
                      text("domain", "Id of the domain."), text("loop_condition", "cl: closed loop."),
                      text("kc_id", "Component, from 1."),
                      text("interaction_type", "demo, diagnostic test or diagnostic feedback."),
                      text("is_opt_response", "1 or 0 for tests.", false),
                      text("mdp_parameters", "JSON with the constraints, normals of half-spaces.")}};
}

TableDescription beliefs_table() {
  return {
      .file = kBeliefsFile,
      .description = "What the teacher believed at the end of a period.",
      .columns = {session_column(), period_column(),
                  text("belief", "Whom the belief is about: member N, or how beliefs were combined, such as common."),
                  integer("member", "Place in the group, from 1; missing for combined beliefs.", false),
                  real("p_bec",
                       "Share of the belief in the set of rewards that lead to the robot's policy: the teacher's "
                       "estimate of what the member knows.")}};
}

TableDescription events_table() {
  return {.file = kEventsFile,
          .description = "One event of a room: everything that happened, in order.",
          .columns = {session_column(), integer("seq", "Number within the room, from 1."),
                      integer("at_us", "When it happened.", true, "us since 1970"),
                      text("actor",
                           "seat:N, facilitator or "
                           "server."),
                      text("type", "What happened."),
                      text("body",
                           "The rest, as JSON; what identifies people and free text are left out unless asked "
                           "for.")}};
}

std::vector<TableDescription> export_tables(const SessionExportOptions& options) {
  std::vector<TableDescription> tables{sessions_table(), participants_table(options), periods_table(), tests_table(),
                                       keys_table(),     questions_table(options),    trials_table(),  beliefs_table(),
                                       events_table()};
  if (options.with_discussions) tables.push_back(discussions_table());
  return tables;
}

}  // namespace kith
