#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "kith/live/room.hpp"
#include "kith/live/taught_people.hpp"
#include "kith/live/world_json.hpp"
#include "kith/study/study_file.hpp"
#include "study_texts.hpp"

namespace kith::testing {

inline const std::string kLiveStudy = R"(schema = "kith.study/1"
id = "live"
domain = "item-delivery"
seed = 11
replicates = 3
[design]
strategies = ["common", "joint", "individual-low", "baseline"]
compositions = ["NNP", "NN", "N"]
)" + kPaperLearners + R"([teacher]
particles = 120
counterfactuals = 4
)";

inline std::shared_ptr<const Atlas> atlas_of(const std::string& domain) {
  static std::vector<std::pair<std::string, std::shared_ptr<const Atlas>>> known;
  for (const auto& [name, atlas] : known) {
    if (name == domain) return atlas;
  }
  std::string text = kLiveStudy;
  text.replace(text.find("item-delivery"), 13, domain);
  auto reading = parse_study(text, "live.toml", {.overrides = {}, .folder = KITH_SOURCE_DIR});
  if (!reading.domain) throw std::logic_error{"no domain " + domain};
  known.emplace_back(domain, std::make_shared<const Atlas>(*std::move(reading.domain)));
  return known.back().second;
}

/// The study with more tables behind it, about a built-in domain or one of a file of the repository.
inline std::shared_ptr<const LiveStudy> live_study(const std::string& group = {},
                                                   const std::string& domain = "item-delivery") {
  std::string text = kLiveStudy + group;
  text.replace(text.find("item-delivery"), 13, domain);
  static std::map<std::string, std::shared_ptr<const LiveStudy>> known;
  auto& study = known[text];
  if (study) return study;
  const auto reading = parse_study(text, "live.toml", {.overrides = {}, .folder = KITH_SOURCE_DIR});
  if (!reading.study) throw std::logic_error{to_text(reading.diagnostics.front())};
  study = make_live_study(*reading.study, atlas_of(domain));
  return study;
}

/// What a waiting list begins with.
inline RoomSetup waiting_list_setup() {
  RoomSetup setup;
  setup.id = "r1";
  setup.code = "ABC";
  setup.strategy = "waiting list";
  setup.salt = "salt";
  setup.is_waiting_list = true;
  return setup;
}

/// A room with a clock, and everything that happened in it.
class Play {
 public:
  Play(std::shared_ptr<const LiveStudy> study, RoomSetup setup)
      : study_{std::move(study)}, cache_{study_->atlas}, room_{study_, std::move(setup), cache_} {}
  explicit Play(std::shared_ptr<const LiveStudy> study, const std::string& composition = "NNP",
                std::vector<bool> simulated = {})
      : Play{std::move(study), RoomSetup{.id = "r1",
                                         .code = "ABC",
                                         .strategy = "common",
                                         .composition = composition,
                                         .simulated = std::move(simulated),
                                         .replicate = 1,
                                         .salt = "salt"}} {}

  [[nodiscard]] const Room& room() const { return room_; }
  [[nodiscard]] const LiveStudy& study() const { return *study_; }
  [[nodiscard]] std::shared_ptr<const LiveStudy> study_of_room() const { return study_; }
  [[nodiscard]] TeachingCache& cache() { return cache_; }
  [[nodiscard]] const std::vector<RoomEvent>& events() const { return events_; }
  /// All that were sent, refused ones too.
  [[nodiscard]] const std::vector<RoomCommand>& commands() const { return commands_; }
  [[nodiscard]] std::int64_t now() const { return now_us_; }

  /// Sends a command and applies what it leads to. @return the refusal's reason; empty if it was accepted.
  std::string send(const std::string& actor, const std::string& type, Json body = Json::object()) {
    commands_.push_back({actor, type, std::move(body), "id"});
    const auto decision = room_.decide(commands_.back(), now_us_);
    if (decision.refusal) return decision.refusal->reason;
    for (const auto& event : decision.events) apply(event);
    settle();
    return {};
  }
  std::string seat(std::size_t number, const std::string& type, Json body = Json::object()) {
    return send(seat_actor(number), type, std::move(body));
  }
  std::string facilitator(const std::string& type, Json body = Json::object()) {
    body["reason"] = "a test";
    return send("facilitator", type, std::move(body));
  }

  /// Lets time pass, second by second where something is due.
  void wait(double seconds) {
    const auto end = now_us_ + static_cast<std::int64_t>(seconds * 1e6);
    settle();
    while (true) {
      const auto next = room_.next_due();
      if (!next || *next > end) break;
      now_us_ = std::max(now_us_, *next);
      settle();
    }
    now_us_ = end;
  }

  /// What is due now, and lessons. Without the teacher, lessons are left for later.
  void settle() {
    for (;;) {
      const auto due = room_.due(now_us_);
      const auto task = teacher_works_ ? room_.teaching() : std::nullopt;
      if (!due.empty()) {
        for (const auto& event : due) apply(event);
      } else if (task) {
        const auto& lesson = taught(*task);
        apply(room_.taught(lesson, now_us_), &lesson);
      } else {
        return;
      }
    }
  }
  void set_teacher(bool works) {
    teacher_works_ = works;
    settle();
  }

  void join(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(send("server", "join"), "");
    }
  }
  void get_ready(std::size_t number, bool right = true) {
    ASSERT_EQ(seat(number, "consent", {{"accept", true}, {"version", study_->group().consent_version}}), "");
    ASSERT_EQ(seat(number, "checked"), "");
    for (std::size_t t = 0; room_.stage_of(number) == "screening"; ++t) {
      const auto start_index = study_->screening[t];
      Json body{{"test", t}, {"actions", right ? right_path(start_index) : Json::array()}, {"ms", 5}};
      if (right && expected_path(*study_->atlas, start_index).repeats_from) body["for_ever"] = true;
      ASSERT_EQ(seat(number, "screen", std::move(body)), "");
    }
  }
  /// Everybody joins and is ready; the session starts if the study says so.
  void start(std::size_t people) { start(people, people); }
  /// Only so many are ready.
  void start(std::size_t people, std::size_t ready) {
    join(people);
    for (std::size_t i = 1; i <= ready; ++i) get_ready(i);
  }

  /// Everybody comes, and has watched what the first lesson shows.
  void start_tests(std::size_t people) {
    start(people);
    for (std::size_t i = 1; i <= people; ++i) watch(i);
  }

  void watch(std::size_t number) {
    while (room_.stage_of(number) == "watch") {
      const auto view = room_.view({Viewer::Role::kParticipant, number}, now_us_);
      ASSERT_EQ(seat(number, "watched", {{"demo", view["watch"]["index"]}}), "");
    }
  }
  void answer(std::size_t number, bool right = true) {
    while (room_.stage_of(number) == "predict") {
      const auto t = room_.view({Viewer::Role::kParticipant, number}, now_us_)["predict"]["index"].get<std::size_t>();
      const auto start_index = room_.session().lesson().tests[t].start;
      Json body{{"test", t}, {"actions", right ? right_path(start_index) : wrong_path(start_index)}, {"ms", 1000}};
      if (right && expected_path(*study_->atlas, start_index).repeats_from) body["for_ever"] = true;
      ASSERT_EQ(seat(number, "answer", std::move(body)), "");
    }
  }
  /// Keeps the answer to the test that the page asks about, or takes another prediction of the board.
  std::string discuss(std::size_t number, bool keep = true) {
    const auto shown = room_.view({Viewer::Role::kParticipant, number}, now_us_)["discuss"];
    Json choice;
    for (std::size_t i = 0; i < shown["predictions"].size() && !keep; ++i) {
      if (!shown["predictions"][i]["own"].get<bool>()) choice = i;
    }
    return seat(number, "discuss", {{"test", shown["index"]}, {"choice", choice}, {"ms", 5}});
  }

  /// One step on whatever page the person is on.
  void act(std::size_t number, bool right = true) {
    const auto stage = room_.stage_of(number);
    if (stage == "watch") watch(number);
    if (stage == "predict") answer(number, right);
    if (stage == "feedback") {
      ASSERT_EQ(seat(number, "continue"), "");
    }
    if (stage == "questions") {
      ASSERT_EQ(seat(number, "questions", {{"answers", Json::object()}}), "");
    }
  }
  /// People act until nothing more can be done by them.
  void play_on(const std::vector<std::size_t>& people, bool right = true, std::size_t rounds = 400) {
    for (std::size_t i = 0; i < rounds && room_.stage() == RoomStage::kRunning; ++i) {
      for (const auto number : people) act(number, right);
    }
  }

  [[nodiscard]] Json right_path(StartIndex start_index) const {
    Json actions = Json::array();
    for (const auto action : expected_path(*study_->atlas, start_index).actions) actions.push_back(action.value());
    return actions;
  }
  /// Another first action, from where the robot goes on as it would; worse than the robot's own path.
  [[nodiscard]] Json wrong_path(StartIndex start_index) const {
    const auto& atlas = *study_->atlas;
    const auto [world, start] = atlas.id(start_index);
    const auto& mdp = atlas.domain().mdp(world);
    for (const auto& choice : mdp.choices(start)) {
      const auto next = mdp.outcomes(choice).front().next;
      if (mdp.is_terminal(next)) continue;
      Json actions = Json::array({choice.action.value()});
      for (const auto action : atlas.trajectory(atlas.index({world, next})).actions) actions.push_back(action.value());
      std::vector<std::size_t> list;
      for (const auto& action : actions) list.push_back(action.get<std::size_t>());
      const auto judged = judged_path(atlas, start_index, list);
      if (!judged.counts) continue;
      if (atlas.domain().weights().return_of(atlas.feature_counts(start_index) - *judged.counts) > 1e-3) return actions;
    }
    return Json::array();  // stops at once
  }

  void expect_replay() {
    const auto again = replay(study_, room_.setup(), events_, cache_);
    EXPECT_EQ(again.digest(), room_.digest());
    EXPECT_EQ(again.seq(), room_.seq());
  }

  void apply(const RoomEvent& event, const TaughtLesson* lesson = nullptr) {
    room_.apply(event, cache_, lesson);
    events_.push_back(event);
    if (on_event) on_event();
  }
  /// The server ends, and what is stored is computed again.
  void restart() { room_ = replay(study_, room_.setup(), events_, cache_); }
  /// Called after everything that happened.
  std::function<void()> on_event;
  /// What whoever looks wants to see besides the lesson.
  std::size_t num_runners_up = 0;

  void pass(double seconds) { now_us_ += static_cast<std::int64_t>(seconds * 1e6); }

 private:
  // Equal keys mean equal lessons, so plays of the same study share them; a replay chooses its own. Studies are kept:
  // of one that was freed, the next would take the address and with it the lessons.
  const TaughtLesson& taught(const TeachingTask& task) {
    static std::map<std::tuple<std::shared_ptr<const LiveStudy>, std::string, std::size_t>, TaughtLesson> known;
    auto& lesson = known[{study_, task.key(), num_runners_up}];
    if (lesson.key.empty()) lesson = task.run(cache_, num_runners_up);
    return lesson;
  }

  std::shared_ptr<const LiveStudy> study_;
  TeachingCache cache_;
  Room room_;
  std::vector<RoomEvent> events_;
  std::vector<RoomCommand> commands_;
  std::int64_t now_us_ = 1'700'000'000'000'000;
  bool teacher_works_ = true;
};

/// What the person in a seat sees now.
inline Json page(const Play& play, std::size_t seat) {
  return play.room().view({Viewer::Role::kParticipant, seat}, play.now());
}

/// Everybody after the events of a play so far.
inline std::vector<TaughtPerson> people_of(Play& play) {
  TaughtPeople taught;
  Room room{play.study_of_room(), play.room().setup(), play.cache()};
  for (const auto& event : play.events()) {
    room.apply(event, play.cache());
    taught.see(room);
  }
  return taught.all(room);
}

}  // namespace kith::testing
