#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kith/learners/discussion.hpp"

namespace kith {

/// What happens to a group when somebody is away.
enum class DropoutPolicy {
  kPauseThenContinue,  ///< The group waits for the grace period, then continues without the person.
  kContinueNow,        ///< The group continues at once; who returns takes part from the next lesson on.
  kSimulate,           ///< After the grace period a simulated learner of the seat's type takes the seat.
  kEndGroup,           ///< After the grace period the session ends for everybody.
};

/// "pause-then-continue", "continue-now", "simulate", "end-group".
[[nodiscard]] std::string_view name_of(DropoutPolicy policy) noexcept;

/// `group.dropout` of a study file.
struct GroupDropout {
  DropoutPolicy policy = DropoutPolicy::kPauseThenContinue;
  std::int64_t grace_s = 90;   ///< Seconds, 0 to 86 400, from the moment at which somebody is found to be away.
  std::size_t min_active = 1;  ///< 1 to 30: with fewer people the session ends.
  friend bool operator==(const GroupDropout&, const GroupDropout&) = default;
};

/// `group.time`: limits in seconds; 0: no limit.
struct GroupTime {
  std::int64_t watch_s = 0;          ///< For all demonstrations of a period.
  std::int64_t predict_s = 0;        ///< For all tests of a period.
  std::int64_t feedback_s = 0;       ///< For the feedback of a period.
  std::int64_t discuss_s = 0;        ///< To keep or change answers, where groups talk.
  std::int64_t lobby_s = 1200;       ///< From the moment at which the first person is ready, until the group starts.
  std::int64_t leave_after_s = 300;  ///< After so long in the lobby a person may leave with a completion code.
  std::int64_t max_minutes = 0;      ///< Minutes of teaching.
  friend bool operator==(const GroupTime&, const GroupTime&) = default;
};

/// A key of `group.time`.
struct GroupTimeKey {
  std::string_view name;
  std::int64_t GroupTime::*member;
  std::int64_t most = 86'400;     ///< The largest value; the smallest is 0.
  bool is_always_written = true;  ///< False: frozen inputs have it only where it is not 0.
};

/// All of them, in the order of written files.
inline constexpr std::array kGroupTimeKeys{
    GroupTimeKey{"watch_s", &GroupTime::watch_s},
    GroupTimeKey{"predict_s", &GroupTime::predict_s},
    GroupTimeKey{"feedback_s", &GroupTime::feedback_s},
    GroupTimeKey{.name = "discuss_s", .member = &GroupTime::discuss_s, .is_always_written = false},
    GroupTimeKey{"lobby_s", &GroupTime::lobby_s},
    GroupTimeKey{"leave_after_s", &GroupTime::leave_after_s},
    GroupTimeKey{"max_minutes", &GroupTime::max_minutes, 86'400 / 60},
};

/// `group.screening`: tests before the lobby.
struct GroupScreening {
  std::size_t tests = 0;  ///< 0 to 20; 0: no screening.
  double cut = 0.5;       ///< In (0, 1): estimates of ability from here on are high.
  friend bool operator==(const GroupScreening&, const GroupScreening&) = default;
};

/// `group.screens`: what the pages of participants do beyond the paper's method. It changes what people learn, not what
/// they are taught.
struct GroupScreens {
  bool predict_first = false;  ///< People sketch the robot's path before they watch it.
  bool brackets = false;       ///< Feedback shows between which bounds each cost lies, by what was shown so far.
  bool explore = false;        ///< After feedback and at the end people may change the world and see the robot's path.
  friend bool operator==(const GroupScreens&, const GroupScreens&) = default;
};

/// A key of `group.screens`.
struct GroupScreenKey {
  std::string_view name;
  bool GroupScreens::*member;
};

/// All of them, in the order of written files.
inline constexpr std::array kGroupScreenKeys{
    GroupScreenKey{"predict_first", &GroupScreens::predict_first},
    GroupScreenKey{"brackets", &GroupScreens::brackets},
    GroupScreenKey{"explore", &GroupScreens::explore},
};

/// `group.discussion`: whether members see each other's answers, without names, before the feedback, and may revise
/// theirs. It is part of how a study is simulated.
struct GroupDiscussion {
  DiscussionChoice choice{};  ///< How simulated members talk; "none": nobody does, people neither.
  friend bool operator==(const GroupDiscussion&, const GroupDiscussion&) = default;
};

/// One of `group.questions`, asked at the end.
struct GroupQuestion {
  enum class Kind { kLikert, kText, kChoice };
  std::string id;
  Kind kind = Kind::kText;
  std::string text;
  std::vector<std::string> options{};  ///< Of a choice, at least two; of a Likert item its steps, or none: 1 to 7.
  std::string low{};                   ///< What the first step of a Likert item means.
  std::string high{};                  ///< What its last step means.
  bool required = false;
  friend bool operator==(const GroupQuestion&, const GroupQuestion&) = default;
};

/// "likert", "text" or "choice".
[[nodiscard]] std::string_view name_of(GroupQuestion::Kind kind) noexcept;

/// `group.completion`: what people get who finished, or could not through no fault of theirs.
struct GroupCompletion {
  std::string prefix = "KITH";  ///< Completion codes begin with it.
  /// Where the last page leads, empty: nowhere. "{code}" and "{NAME}" are filled in, NAME a collected query parameter.
  std::string redirect{};
  bool pay_full = true;  ///< Whether people for whom there was no seat get a code, too.
  friend bool operator==(const GroupCompletion&, const GroupCompletion&) = default;
};

/// `[group]` of a study file: how groups of people are taught live. All but `discussion` changes nothing in how a study
/// is simulated.
struct GroupOptions {
  std::string title = "Learn how a robot works";  ///< What participants read; it says nothing about the reward.
  std::vector<std::string> story{};               ///< Paragraphs; empty: a standard text.
  std::string goal{};                             ///< Empty: a standard text.
  std::string consent_version = "1";
  std::vector<std::string> consent_text{};  ///< Paragraphs; empty without a file: a standard text.
  std::string consent_file{};  ///< Relative to the study file: paragraphs separated by empty lines; excludes the text.
  std::string language{};      ///< A JSON file with the texts of pages, relative to the study file; empty: English.
  bool auto_start = true;      ///< Start as soon as everybody is ready; false: the facilitator starts.
  std::size_t size = 0;        ///< 0, or 1 to 30: shorter compositions are filled up with their last letter.
  std::vector<std::size_t> people{};  ///< Seats of people, from 1, ascending; the others are simulated; empty: all.
  GroupDropout dropout{};
  GroupTime time{};
  GroupScreening screening{};
  GroupScreens screens{};
  GroupDiscussion discussion{};
  /// `group.screening.high`, letters of learner types: their places are for people with high estimates, the others for
  /// people with low ones. Empty: the estimates are shown to the facilitator and decide nothing.
  std::string high_types{};
  std::vector<GroupQuestion> questions{};
  GroupCompletion completion{};
  bool exam = false;  ///< After the lessons everybody is examined, alone; see Examination.
  bool ask_name = false;
  std::vector<std::string> collect_query{};  ///< Query parameters of a recruitment platform that are kept.
  friend bool operator==(const GroupOptions&, const GroupOptions&) = default;
};

}  // namespace kith
