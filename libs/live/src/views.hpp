#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kith/live/message.hpp"

namespace kith {

/// What people see: records whose fields are those of the views in JSON, in order. The types of the pages,
/// web/src/live/protocol.ts and web/src/facilitator/room.ts, are printed from them. Where another layer says what JSON
/// there is, its type in TypeScript stands behind it.
namespace view {

using Count = std::size_t;
using Ms = std::int64_t;  // of a duration, or since 1970
using Text = std::string;
using Texts = std::vector<std::string>;
template <typename T>
using OrNull = std::optional<T>;

template <Name kName>
using Board = Field<kName, Json, "PlayBoard">;
using ItsPath = Field<"", Json, "Path">;

/// Something to drive: `world` is the key of its table of moves, `start` a state of that table.
using Task = Record<"Task", Field<"index", Count>, Field<"of", Count>, Board<"board">, Field<"world", Text>,
                    Field<"start", Count>, Field<"draft", std::vector<Count>>>;

/// Where a move at the fork could lead: the start in its table of moves, and which costs the robot's move avoids.
using Chance = Record<"", Field<"world", Text>, Field<"state", Count>, Field<"spared", std::vector<Count>>>;

/// A prediction beside the robot's path. `..._repeats_from` and `robot_repeats_text` are those of a Path; `unfinished`:
/// the prediction ends before the robot has finished.
using Judged = Record<"Judged", Board<"board">, Field<"right", bool>, Field<"mine", Json, "Frame[] | null">,
                      Field<"robot", Json, "Frame[]">, Field<"differs_at", OrNull<Count>>, Field<"why", Texts>,
                      Maybe<"chance", Chance>, IfSet<"mine_repeats_from", Json, "number">,
                      IfSet<"robot_repeats_from", Json, "number">, IfSet<"robot_repeats_text", Json, "string">,
                      Field<"unfinished", bool>, Maybe<"cost", Text>>;

/// Where the robot goes from `board.start`, and the best path that trades something for something else; `tie`: that is
/// worth the same to it.
using Found = Record<"", Board<"board">, Field<"other", Json, "Path | null">, Field<"differs_at", OrNull<Count>>,
                     Field<"tie", bool>, Maybe<"reason", Text>, Field<"path", Json, "Path">>;
/// `impossible`: the robot cannot do its job there, or nobody can be there.
using Explored = Record<"Explored", IfSet<"impossible", bool>, Field<"", std::optional<Found>>>;

using Question =
    Record<"Question", Field<"id", Text>, Field<"kind", Text, "'likert' | 'text' | 'choice'">, Field<"text", Text>,
           IfSet<"options", Texts>, IfSet<"low", Text>, IfSet<"high", Text>, Field<"required", bool>>;

/// Why the group stands still.
using Pause = Record<"Pause", Field<"why", Text, "'someone-away' | 'facilitator'">, Field<"since_ms", Ms>,
                     Maybe<"until_ms", Ms>, Field<"missing", Count>>;

/// What is new about a robot, and what is not, for those who know it as it was; `news`: all that is new.
using Update = Record<"Update", Field<"now", Texts>, Field<"still", Texts>, Field<"news", Texts>>;
using Study = Record<"", Field<"title", Text>, Field<"story", Texts>, Field<"goal", Text>, Maybe<"update", Update>>;
using Me = Record<"", Field<"label", Text>>;
using Group = Record<"", Field<"size", Count>>;
using Notice = Record<"", Field<"text", Text>, Field<"at_ms", Ms>>;
using Progress = Record<"", Field<"part", Count>, Field<"round", Count>, Field<"most", Count>, Field<"parts", Count>>;
using Consent = Record<"", Field<"version", Text>, Field<"paragraphs", Texts>, Field<"stores", Json, "Stores">>;
using Check = Record<"", Board<"board">, Field<"world", Text>, Field<"start", Count>, Field<"parts", Count>,
                     Field<"most", Count>, Field<"ask_name", bool>>;
/// `leave_after_ms`: from when on one may leave.
using Lobby = Record<"", Field<"present", Count>, Field<"size", Count>, Field<"since_ms", Ms>,
                     Field<"leave_after_ms", Ms>, Maybe<"until_ms", Ms>>;
/// A demonstration; `world` and `state` are its table of moves and the start in it, if people sketch the path first.
using Watch = Record<"", Field<"index", Count>, Field<"of", Count>, Board<"board">, ItsPath, Maybe<"world", Text>,
                     Maybe<"state", Count>, IfSet<"runs", Json, "Runs">>;
/// What the group predicted for a test, every path once, without names; `n`: how many predicted it.
using Prediction = Record<"", ItsPath, Field<"own", bool>, Field<"n", Count>>;
using Discussion = Record<"", Field<"index", Count>, Field<"of", Count>, Board<"board">,
                          Field<"predictions", std::vector<Prediction>>>;
using Wait =
    Record<"",
           Field<"for", Text,
                 "'answers' | 'others-watching' | 'discussion' | 'teacher' | 'feedback' | 'joining' | 'rejoining'">,
           Field<"missing", Count>, Field<"since_ms", Ms>>;
/// `others_unsure`: somebody else was not right, which is why the group goes on.
using Feedback = Record<"", Field<"tests", std::vector<Judged>>, Field<"all_right", bool>, Field<"learned", bool>,
                        Field<"others_unsure", bool>, IfSet<"brackets", Json, "Bracket[]">>;
/// Where the study lets people change the world: `put` are symbols that may stand anywhere on the map.
using Explore = Record<"", Field<"first", Explored>, Field<"put", Texts>, Field<"brackets", Json, "Bracket[]">,
                       Maybe<"last", Explored>>;
using Questions = Record<"", Field<"items", std::vector<Question>>>;
/// What the robot is like: of the parts that the group had lessons about, and of the others.
using Debrief = Record<"", Field<"summary", Texts>, Field<"not_reached", Texts>, Field<"code", Text>,
                       Field<"rounds", Count>, Field<"right", Count>, Field<"tests", Count>, IfSet<"redirect", Text>>;
using End = Record<"", Field<"reason", Text>, Field<"text", Text>, IfSet<"code", Text>, IfSet<"redirect", Text>>;

/// What a participant sees. At most one of the fields named after stages is set; `predict` is also that of the stages
/// screening and exam, where `of` is how many there are at most. `limit_ms`: when a time limit ends the stage.
using Participant = Record<
    "ParticipantView",
    Field<
        "stage", Text,
        "'consent' | 'check' | 'screening' | 'lobby' | 'watch' | 'predict' | 'discuss' | 'wait' | 'feedback' | 'exam' "
        "| 'questions' | 'debrief' | 'declined' | 'full' | 'ended' | 'replaced'">,
    Field<"lang", Text>, Field<"study", Study>, Field<"me", Me>, Field<"group", Group>,
    Field<"notices", std::vector<Notice>>, Maybe<"pause", Pause>, Maybe<"progress", Progress>,
    Maybe<"consent", Consent>, Maybe<"check", Check>, Maybe<"lobby", Lobby>, Maybe<"watch", Watch>,
    Maybe<"predict", Task>, Maybe<"discuss", Discussion>, Maybe<"wait", Wait>, Maybe<"feedback", Feedback>,
    Maybe<"questions", Questions>, Maybe<"debrief", Debrief>, Maybe<"end", End>, Maybe<"explore", Explore>,
    Maybe<"limit_ms", Ms>, Field<"server_ms", Ms>>;

// --- what facilitators and observers see; observers get no names and codes ------------------------------------------

/// A seat of a room. `since_ms` is that of the presence, 0: nobody has come yet; `member` of the session, from 1, where
/// it is not the seat; `dropped`: the group goes on without them. The service adds what a room does not know:
/// `latency_ms`, `link` and why somebody `needs_help`.
using SeatRow = Record<
    "SeatRow", Field<"seat", Count>, Field<"label", Text>, IfSet<"name", Text>,
    Field<"kind", Text, "'person' | 'simulated'">, Field<"type", Text>,
    Field<"presence", Text, "'here' | 'away' | 'left' | 'empty'">,
    Field<"status", Text,
          "'empty' | 'active' | 'finished' | 'left' | 'dropped' | 'replaced' | 'withdrawn' | 'ended' | 'declined' "
          "| 'full' | 'moved' | 'simulated'">,
    Field<"dropped", bool>, Field<"since_ms", Ms>, Maybe<"member", Count>, Field<"stage", Text>,
    Maybe<"stage_since_ms", Ms>, Maybe<"right", Count>, Maybe<"tests", Count>, Maybe<"estimate", double>,
    Maybe<"estimate_is_high", bool>, IfSet<"code", Text>, Maybe<"latency_ms", double>, IfSet<"link", Text>,
    IfSet<"needs_help", Text>>;

/// What is still to come; `done_within`: the probability that everything is learned after 1, 2, 3 more periods.
using Forecast = Record<"Forecast", Field<"periods", double>, Field<"minutes_low", double>,
                        Field<"minutes_high", double>, IfSet<"done_within", std::vector<double>>>;

using RoomRow =
    Record<"RoomRow", Field<"id", Text>, Maybe<"code", Text>,
           Field<"stage", Text, "'lobby' | 'running' | 'paused' | 'questions' | 'ended'">, Field<"strategy", Text>,
           Field<"composition", Text>, IfSet<"waiting_list", bool>, Field<"seats", std::vector<SeatRow>>,
           Field<"period", Count>, Field<"component", Count>, Maybe<"started_ms", Ms>, IfSet<"ended", Text>,
           Maybe<"forecast", Forecast>, Maybe<"next_strategy", Text>>;

using ComponentState = Record<"", Field<"name", Text>, Field<"status", Text, "'open' | 'learned' | 'skipped'">>;
using SessionNow = Record<"", Field<"component", OrNull<Count>>, Field<"components", std::vector<ComponentState>>,
                          Field<"phase", Text>>;
/// A demonstration, with its `gain`, or a test.
using ShownBoard = Record<"ShownBoard", Board<"board">, ItsPath, Maybe<"gain", double>, Field<"sentences", Texts>>;
/// What else the teacher could have shown.
using OtherBoard = Record<"RunnerUp", Board<"board">, Field<"gain", double>, Field<"sentences", Texts>>;
using LessonNow =
    Record<"LessonNow", Field<"source", Text>, Field<"why", Text>, Field<"demonstrations", std::vector<ShownBoard>>,
           Field<"tests", std::vector<ShownBoard>>, Field<"runners_up", std::vector<OtherBoard>>>;
/// `changed`: where groups talk, whether another prediction was taken instead.
using GivenAnswer = Record<"Answer", Field<"seat", Count>, Field<"period", Count>, Field<"test", Count>,
                           Field<"right", bool>, Field<"regret", double>, Field<"ms", Ms>, Field<"stopped_short", bool>,
                           Maybe<"changed", bool>, Maybe<"right_in_the_end", bool>>;
using CurvePoint = Record<"", Field<"period", Count>, Field<"p_bec", Json, "Record<string, number>">,
                          Field<"right", Json, "Record<string, number>">>;
using Belief = Record<"Belief", Field<"name", Text>, Field<"points", Text>>;
using Corners = std::vector<std::vector<double>>;
using Truth = Record<"Truth", Field<"weights", std::vector<double>>, Field<"features", Texts>, Field<"bec", Corners>,
                     Field<"prior", Corners>>;
using Timer = Record<"Timer", Field<"name", Text>, Field<"since_ms", Ms>, Maybe<"until_ms", Ms>>;

using KnownComponent = Record<"", Field<"name", Text>, Field<"verdict", Text>, Field<"level", OrNull<double>>>;
/// Who understands what, by a person's answers so far. `exam`: what it came to, once it has begun; `knows`: how often
/// they are expected to get all of a component right; `thinks`: the misconception that is most probable; `kind`: of
/// learner.
using KnownPerson = Record<"PersonAudit", Field<"seat", Count>, Field<"tests", Count>, Field<"right", Count>,
                           Field<"knows", double>, Field<"components", std::vector<KnownComponent>>,
                           Maybe<"exam", Text, "'understands' | 'does-not-understand' | 'cannot-tell'">,
                           IfSet<"needs_help", Text>, Maybe<"thinks", Text>, Maybe<"probability", double>,
                           Maybe<"kind", Text>, IfSet<"kinds", Json, "Record<string, number>">>;

/// The service adds `people`.
using RoomDetail = Record<"RoomDetail", Field<"id", Text>, Field<"session", SessionNow>, Maybe<"lesson", LessonNow>,
                          Field<"answers", std::vector<GivenAnswer>>, Field<"curves", std::vector<CurvePoint>>,
                          Field<"beliefs", std::vector<Belief>>, Field<"truth", Truth>,
                          Field<"timers", std::vector<Timer>>, IfSet<"people", std::vector<KnownPerson>>>;

}  // namespace view
}  // namespace kith
