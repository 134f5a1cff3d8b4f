#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kith/live/message.hpp"

namespace kith {

/// What people see: structs whose members are those of the views in JSON, in order. The types of the pages,
/// web/src/live/protocol.ts, are printed from them. JSON stands where another layer says what there is; the text behind
/// it is its type in TypeScript.
namespace view {

/// Something to drive: `world` is the key of its table of moves, `start` a state of that table.
struct Task {
  static constexpr std::string_view kType = "Task";
  std::size_t index = 0, of = 0;
  Json board{};
  std::string world{};
  std::size_t start = 0;
  std::vector<std::size_t> draft{};
  static constexpr auto kMembers =
      members("index", &Task::index, "of", &Task::of, "board", &Task::board, As{"PlayBoard"}, "world", &Task::world,
              "start", &Task::start, "draft", &Task::draft);
};

/// Where a move at the fork could lead: the start in its table of moves, and which costs the robot's move avoids.
struct Chance {
  std::string world{};
  std::size_t state = 0;
  std::vector<std::size_t> spared{};
  static constexpr auto kMembers = members("world", &Chance::world, "state", &Chance::state, "spared", &Chance::spared);
};

/// A prediction beside the robot's path. `..._repeats_from` and `..._repeats_text` are those of a Path; `unfinished`:
/// the prediction ends before the robot has finished.
struct Judged {
  static constexpr std::string_view kType = "Judged";
  Json board{};
  bool right = false;
  Json mine{}, robot{};
  std::optional<std::size_t> differs_at{};
  std::vector<std::string> why{};
  std::optional<Chance> chance{};
  Json mine_repeats_from{}, mine_repeats_text{}, robot_repeats_from{}, robot_repeats_text{};
  bool unfinished = false;
  std::optional<std::string> cost{};
  static constexpr auto kMembers =
      members("board", &Judged::board, As{"PlayBoard"}, "right", &Judged::right, "mine", &Judged::mine,
              As{"Frame[] | null"}, "robot", &Judged::robot, As{"Frame[]"}, "differs_at", &Judged::differs_at, "why",
              &Judged::why, "chance?", &Judged::chance, "mine_repeats_from?", &Judged::mine_repeats_from, As{"number"},
              "mine_repeats_text?", &Judged::mine_repeats_text, As{"string"}, "robot_repeats_from?",
              &Judged::robot_repeats_from, As{"number"}, "robot_repeats_text?", &Judged::robot_repeats_text,
              As{"string"}, "unfinished", &Judged::unfinished, "cost?", &Judged::cost);
};

/// Where the robot goes from `board.start`, and the best path that trades something for something else; `tie`: that is
/// worth the same to it.
struct Found {
  Json board{}, other{};
  std::optional<std::size_t> differs_at{};
  bool tie = false;
  std::optional<std::string> reason{};
  Json path{};
  static constexpr auto kMembers =
      members("board", &Found::board, As{"PlayBoard"}, "other", &Found::other, As{"Path | null"}, "differs_at",
              &Found::differs_at, "tie", &Found::tie, "reason?", &Found::reason, "path", &Found::path, As{"Path"});
};

/// `impossible`: the robot cannot do its job there, or nobody can be there.
struct Explored {
  static constexpr std::string_view kType = "Explored";
  bool impossible = false;
  std::optional<Found> found{};
  static constexpr auto kMembers = members("impossible?", &Explored::impossible, "", &Explored::found);
};

struct Question {
  static constexpr std::string_view kType = "Question";
  std::string id{}, kind{}, text{};
  std::vector<std::string> options{};
  std::string low{}, high{};
  bool required = false;
  static constexpr auto kMembers =
      members("id", &Question::id, "kind", &Question::kind, As{"'likert' | 'text' | 'choice'"}, "text", &Question::text,
              "options?", &Question::options, "low?", &Question::low, "high?", &Question::high, "required",
              &Question::required);
};

/// Why the group stands still.
struct Pause {
  static constexpr std::string_view kType = "Pause";
  std::string why{};
  std::int64_t since_ms = 0;
  std::optional<std::int64_t> until_ms{};
  std::size_t missing = 0;
  static constexpr auto kMembers = members("why", &Pause::why, As{"'someone-away' | 'facilitator'"}, "since_ms",
                                           &Pause::since_ms, "until_ms?", &Pause::until_ms, "missing", &Pause::missing);
};

/// What is new about a robot, and what is not, for those who know it as it was; `news`: all that is new.
struct Update {
  static constexpr std::string_view kType = "Update";
  std::string text{};
  std::vector<std::string> now{}, still{}, news{};
  static constexpr auto kMembers =
      members("text", &Update::text, "now", &Update::now, "still", &Update::still, "news", &Update::news);
};

struct Texts {
  std::string title{};
  std::vector<std::string> story{};
  std::string goal{};
  std::optional<Update> update{};
  static constexpr auto kMembers =
      members("title", &Texts::title, "story", &Texts::story, "goal", &Texts::goal, "update?", &Texts::update);
};

struct Me {
  std::size_t seat = 0;
  std::string label{};
  static constexpr auto kMembers = members("seat", &Me::seat, "label", &Me::label);
};

struct Group {
  std::size_t size = 0, active = 0;
  static constexpr auto kMembers = members("size", &Group::size, "active", &Group::active);
};

struct Notice {
  std::string text{};
  std::int64_t at_ms = 0;
  static constexpr auto kMembers = members("text", &Notice::text, "at_ms", &Notice::at_ms);
};

struct Progress {
  std::size_t part = 0, round = 0, most = 0, parts = 0;
  double done = 0.0;
  static constexpr auto kMembers = members("part", &Progress::part, "round", &Progress::round, "most", &Progress::most,
                                           "parts", &Progress::parts, "done", &Progress::done);
};

struct Consent {
  std::string version{};
  std::vector<std::string> paragraphs{};
  Json stores{};
  static constexpr auto kMembers = members("version", &Consent::version, "paragraphs", &Consent::paragraphs, "stores",
                                           &Consent::stores, As{"Stores"});
};

struct Check {
  Json board{};
  std::string world{};
  std::size_t start = 0, parts = 0, most = 0;
  bool ask_name = false;
  static constexpr auto kMembers =
      members("board", &Check::board, As{"PlayBoard"}, "world", &Check::world, "start", &Check::start, "parts",
              &Check::parts, "most", &Check::most, "ask_name", &Check::ask_name);
};

/// `leave_after_ms`: from when on one may leave.
struct Lobby {
  std::size_t present = 0, size = 0;
  std::int64_t since_ms = 0, leave_after_ms = 0;
  std::optional<std::int64_t> until_ms{};
  static constexpr auto kMembers =
      members("present", &Lobby::present, "size", &Lobby::size, "since_ms", &Lobby::since_ms, "leave_after_ms",
              &Lobby::leave_after_ms, "until_ms?", &Lobby::until_ms);
};

/// A demonstration; `world` and `state` are its table of moves and the start in it, if people sketch the path first.
struct Watch {
  std::size_t index = 0, of = 0;
  Json board{}, path{};
  std::optional<std::string> world{};
  std::optional<std::size_t> state{};
  Json runs{};
  static constexpr auto kMembers =
      members("index", &Watch::index, "of", &Watch::of, "board", &Watch::board, As{"PlayBoard"}, "", &Watch::path,
              As{"Path"}, "world?", &Watch::world, "state?", &Watch::state, "runs?", &Watch::runs, As{"Runs"});
};

/// What one or several predicted; `n`: how many.
struct Prediction {
  Json path{};
  bool own = false;
  std::size_t n = 0;
  static constexpr auto kMembers =
      members("", &Prediction::path, As{"Path"}, "own", &Prediction::own, "n", &Prediction::n);
};

/// What the group predicted for a test, every path once, without names.
struct Discussion {
  std::size_t index = 0, of = 0;
  Json board{};
  std::vector<Prediction> predictions{};
  static constexpr auto kMembers =
      members("index", &Discussion::index, "of", &Discussion::of, "board", &Discussion::board, As{"PlayBoard"},
              "predictions", &Discussion::predictions);
};

struct Wait {
  std::string what{};
  std::size_t missing = 0;
  std::int64_t since_ms = 0;
  static constexpr auto kMembers =
      members("for", &Wait::what,
              As{"'answers' | 'others-watching' | 'discussion' | 'teacher' | 'feedback' | 'joining' | 'rejoining'"},
              "missing", &Wait::missing, "since_ms", &Wait::since_ms);
};

/// `others_unsure`: somebody else was not right, which is why the group goes on.
struct Feedback {
  std::vector<Judged> tests{};
  bool all_right = false, learned = false, others_unsure = false;
  Json brackets{};
  static constexpr auto kMembers =
      members("tests", &Feedback::tests, "all_right", &Feedback::all_right, "learned", &Feedback::learned,
              "others_unsure", &Feedback::others_unsure, "brackets?", &Feedback::brackets, As{"Bracket[]"});
};

/// Where the study lets people change the world: `put` are symbols that may stand anywhere on the map.
struct Explore {
  Explored first{};
  std::vector<std::string> put{};
  Json brackets{};
  std::optional<Explored> last{};
  static constexpr auto kMembers = members("first", &Explore::first, "put", &Explore::put, "brackets",
                                           &Explore::brackets, As{"Bracket[]"}, "last?", &Explore::last);
};

struct Questions {
  std::vector<Question> items{};
  static constexpr auto kMembers = members("items", &Questions::items);
};

/// What the robot is like: of the parts that the group had lessons about, and of the others.
struct Debrief {
  std::vector<std::string> summary{}, not_reached{};
  std::string code{};
  std::size_t rounds = 0, right = 0, tests = 0;
  std::string redirect{};
  static constexpr auto kMembers =
      members("summary", &Debrief::summary, "not_reached", &Debrief::not_reached, "code", &Debrief::code, "rounds",
              &Debrief::rounds, "right", &Debrief::right, "tests", &Debrief::tests, "redirect?", &Debrief::redirect);
};

struct End {
  std::string reason{}, text{}, code{}, redirect{};
  static constexpr auto kMembers =
      members("reason", &End::reason, "text", &End::text, "code?", &End::code, "redirect?", &End::redirect);
};

/// What a participant sees. At most one of the members named after stages is set; `predict` is also that of the stages
/// screening and exam, where `of` is how many there are at most. `limit_ms`: when a time limit ends the stage.
struct Participant {
  static constexpr std::string_view kType = "ParticipantView";
  std::size_t v = 1;
  std::string stage{}, lang{}, dir{};
  Texts study{};
  Me me{};
  Group group{};
  std::vector<Notice> notices{};
  std::optional<Pause> pause{};
  std::optional<Progress> progress{};
  std::optional<Consent> consent{};
  std::optional<Check> check{};
  std::optional<Lobby> lobby{};
  std::optional<Watch> watch{};
  std::optional<Task> predict{};
  std::optional<Discussion> discuss{};
  std::optional<Wait> wait{};
  std::optional<Feedback> feedback{};
  std::optional<Questions> questions{};
  std::optional<Debrief> debrief{};
  std::optional<End> end{};
  std::optional<Explore> explore{};
  std::optional<std::int64_t> limit_ms{};
  std::int64_t server_ms = 0;
  static constexpr auto kMembers = members(
      "v", &Participant::v, "stage", &Participant::stage,
      As{"'consent' | 'check' | 'screening' | 'lobby' | 'watch' | 'predict' | 'discuss' | 'wait' | 'feedback' | 'exam' "
         "| 'questions' | 'debrief' | 'declined' | 'full' | 'ended' | 'replaced'"},
      "lang", &Participant::lang, "dir", &Participant::dir, As{"'ltr' | 'rtl'"}, "study", &Participant::study, "me",
      &Participant::me, "group", &Participant::group, "notices", &Participant::notices, "pause?", &Participant::pause,
      "progress?", &Participant::progress, "consent?", &Participant::consent, "check?", &Participant::check, "lobby?",
      &Participant::lobby, "watch?", &Participant::watch, "predict?", &Participant::predict, "discuss?",
      &Participant::discuss, "wait?", &Participant::wait, "feedback?", &Participant::feedback, "questions?",
      &Participant::questions, "debrief?", &Participant::debrief, "end?", &Participant::end, "explore?",
      &Participant::explore, "limit_ms?", &Participant::limit_ms, "server_ms", &Participant::server_ms);
};

}  // namespace view
}  // namespace kith
