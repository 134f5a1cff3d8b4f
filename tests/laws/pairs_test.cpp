// Whatever can be combined works together: a covering array over what a session can be made of, in which every two
// choices meet at least once, each a short session to its end. Nothing throws, nothing that is allowed is refused, the
// lessons are the same in every medium and whoever looks, and figures are the same on every page.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "covering_array.hpp"
#include "kith/learners/discussion.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/live/lesson_log.hpp"
#include "kith/service/lesson_log.hpp"
#include "kith/store/session_study.hpp"
#include "kith/study/team_run.hpp"
#include "kith/teaching/stop_rule.hpp"
#include "live_play.hpp"
#include "random_domains.hpp"
#include "scratch_folder.hpp"

extern "C" const char* kith_engine(const char* request);

namespace kith::laws {
namespace {

using kith::testing::CoveringArray;
using kith::testing::Factor;
using kith::testing::Level;
using kith::testing::Play;
using kith::testing::ScratchFolder;

enum : std::size_t { kMedium, kStrategy, kLearner, kMastery, kRelease, kDiscussion, kScreens, kWatch, kEvent, kDomain };

// What cannot be: studies have nobody who looks or leaves, only they release members and know the truth about them;
// nobody but the person looks at a lesson, and nobody else notices that they are away.
CoveringArray made_pairs() {
  std::vector<Factor> factors{{"medium", {"study", "live", "lesson-page", "lesson-engine"}},
                              {"strategy", {}},
                              {"learner", {}},
                              {"mastery", {}},
                              {"release", {"none"}},
                              {"discussion", {}},
                              {"screens", {"none", "predict_first", "brackets", "explore", "all"}},
                              {"watch", {"nobody", "facilitator", "facilitator-late", "observer", "both"}},
                              {"event", {"none", "reload", "restart", "away", "leave"}},
                              {"domain", {"exact", "features", "chance", "discount", "endless", "explicit"}}};
  for (const auto& kind : strategy_kinds()) factors[kStrategy].levels.emplace_back(kind.name);
  for (const auto* model : learner_models()) factors[kLearner].levels.emplace_back(model->kind);
  for (const auto& kind : stop_rule_kinds()) {
    factors[kMastery].levels.emplace_back(kind.name);
    if (kind.released != nullptr) factors[kRelease].levels.emplace_back(kind.name);
  }
  for (const auto& model : discussion_models()) factors[kDiscussion].levels.emplace_back(model.name);

  const auto word = [factors](const Level& level) { return factors[level.factor].levels[level.level]; };
  return CoveringArray{factors, [=](const Level& a, const Level& b) {
                         if ((a.factor == kMastery || a.factor == kRelease) && word(a) == "regret") {
                           return b.factor != kDomain || word(b) == "exact";  // tabulated
                         }
                         if (a.factor != kMedium) return true;
                         const auto medium = word(a), what = word(b);
                         const bool is_study = medium == "study", is_lesson = medium.rfind("lesson", 0) == 0;
                         if (b.factor == kStrategy) return is_study || !find_strategy_kind(what)->needs_truth;
                         if (b.factor == kRelease) return is_study || what == "none";
                         if (b.factor == kWatch && is_study) return what == "nobody";
                         if (b.factor == kWatch && is_lesson) return what == "nobody" || what == "facilitator";
                         if (b.factor == kEvent && is_study) return what == "none";
                         if (b.factor == kEvent && is_lesson) return what != "away";
                         return true;
                       }};
}

const CoveringArray& pairs() {
  static const auto array = made_pairs();
  return array;
}

// The first of random domains that has so many features.
DomainText first_with(const std::function<DomainText(RandomStream)>& draw, std::size_t least, std::size_t most) {
  for (std::uint64_t i = 0;; ++i) {
    auto text = draw(RandomStream{54}.split(i));
    const auto reading = text.read();
    const auto features = reading.domain->num_features();
    if (features >= least && features <= most) return text;
  }
}

// A file of the domain of that class, in the folder.
std::string domain_file(const ScratchFolder& folder, const std::string& kind) {
  static std::map<std::string, DomainText> known;
  if (known.empty()) {
    known.emplace("exact", first_with(random_map, 3, 3));
    known.emplace("features", first_with(random_map, 4, 5));
    known.emplace("chance", first_with([](RandomStream random) { return random_model(random, 0.2); }, 3, 4));
    known.emplace("discount", with_discount(known.at("exact"), 0.9));
    known.emplace("endless", robot_that_never_ends());
    known.emplace("explicit", first_with([](RandomStream random) { return random_model(random, 0.0); }, 3, 4));
  }
  const auto& text = known.at(kind);
  for (const auto& [name, content] : text.files) folder.write(name, content);
  folder.write("domain.toml", text.toml());
  return "domain.toml";
}

// One row of the array, in words.
struct Combination {
  std::map<std::size_t, std::string> what;
  [[nodiscard]] const std::string& operator[](std::size_t factor) const { return what.at(factor); }
  [[nodiscard]] bool is_alone() const {
    return what.at(kMedium).rfind("lesson", 0) == 0 || (what.at(kStrategy) == "baseline" && what.at(kMedium) == "live");
  }
  [[nodiscard]] bool is_watched_by(const std::string& who) const {
    return what.at(kWatch) == who || what.at(kWatch) == "both";
  }
};

std::string study_text(const Combination& row, const std::string& domain, std::size_t seed) {
  const auto learner = [&](const char* letter, const std::string& kind, const char* ability) {
    return std::string{"[learner."} + letter + "]\nkind = \"" + kind + "\"\nability = { mean = " + ability +
           ", sd = 0.03 }\nconfirm_gain = { half_normal = 0.03 }\ncorrect_gain = { half_normal = 0.05 }\n";
  };
  std::string screens;
  for (const auto& key : kGroupScreenKeys) {
    if (row[kScreens] == "all" || row[kScreens] == key.name) screens += std::string{key.name} + " = true\n";
  }
  const std::string alone = row.is_alone() ? "N" : "NNP";
  return "schema = \"kith.study/1\"\nid = \"pair\"\ntitle = \"A pair\"\ndomain = \"" + domain +
         "\"\nseed = " + std::to_string(seed) + "\nreplicates = 1\n[design]\nstrategies = [\"" + row[kStrategy] +
         "\"]\ncompositions = [\"" + alone + "\"]\n" + learner("N", row[kLearner], "0.7") +
         learner("P", "bayesian", "0.8") + "[teacher]\nparticles = 60\ncounterfactuals = 3\n[stop]\nmax_periods = 4\n" +
         "mastery = \"" + row[kMastery] + "\"\n" +
         (row[kRelease] == "none" ? "" : "release = \"" + row[kRelease] + "\"\n") +
         "[group]\ndropout = { policy = \"continue-now\" }\n"
         "questions = [{ id = \"a\", kind = \"likert\", text = \"?\", required = true }]\n[group.screens]\n" +
         screens + "[group.discussion]\nmodel = \"" + row[kDiscussion] + "\"\n";
}

// The last session of a simulated team.
class LastSession final : public TeamObserver {
 public:
  void on_session(const Session&, std::span<const std::size_t>) override {}
  void on_lesson(const Session&, const Lesson&, const Learners&) override {}
  void on_feedback(const Session&, const Lesson&, const std::vector<Learner::Response>&, const Feedback&,
                   const Learners&) override {}
  void on_end(const Session& session, const Learners&) override { end.emplace(session); }
  std::optional<Session> end;
};

// What a facilitator's and an observer's page, the page of the room, the robot's debriefing and the session say of how
// many answers were right.
void expect_same_figures(const Play& play) {
  const auto view = play.room().view({Viewer::Role::kFacilitator, 0}, play.now());
  const auto watched = play.room().view({Viewer::Role::kObserver, 0}, play.now());
  EXPECT_EQ(view.at("room"), watched.at("room"));
  std::map<std::size_t, std::size_t> right, tests;
  for (const auto& answer : view.at("room").at("answers")) {
    ++tests[answer.at("seat")];
    right[answer.at("seat")] += answer.at("right").get<bool>() ? 1u : 0u;
  }
  for (const auto& seat : view.at("row").at("seats")) {
    const auto number = seat.at("seat").get<std::size_t>();
    EXPECT_EQ(seat.value("tests", std::size_t{0}), tests[number]);
    EXPECT_EQ(seat.value("right", std::size_t{0}), right[number]);
    if (!play.room().is_person(number) || play.room().stage_of(number) != "debrief") continue;
    const auto page = play.room().view({Viewer::Role::kParticipant, number}, play.now());
    EXPECT_EQ(page.at("debrief").at("tests"), tests[number]);
    EXPECT_EQ(page.at("debrief").at("right"), right[number]);
  }
}

// Everybody who looks, after everything that happens.
void watch(const Combination& row, Play& play) {
  const auto is_late = row[kWatch] == "facilitator-late";
  play.on_event = [&play, &row, is_late] {
    const auto& room = play.room();
    const bool is_there = !is_late || (room.holds_session() && room.session().periods() > 0);
    const bool is_facilitated = is_there && (is_late || row.is_watched_by("facilitator"));
    play.num_runners_up = is_facilitated || row.is_watched_by("observer") ? 4 : 0;
    for (const auto role : {Viewer::Role::kFacilitator, Viewer::Role::kObserver}) {
      const bool looks = role == Viewer::Role::kFacilitator ? is_facilitated : row.is_watched_by("observer");
      if (!looks) continue;
      EXPECT_FALSE(room.view({role, 0}, play.now()).dump().empty());
    }
    for (std::size_t seat = 1; seat <= room.num_seats(); ++seat) {
      if (!room.is_person(seat)) continue;
      EXPECT_FALSE(room.view({Viewer::Role::kParticipant, seat}, play.now()).dump().empty());
    }
  };
}

// What happens once, when something has been taught. @return whether it is time.
bool happens(const Combination& row, Play& play) {
  if (play.room().session().periods() == 0) return false;
  const auto& event = row[kEvent];
  if (event == "reload") {
    for (int i = 0; i < 2; ++i) EXPECT_EQ(play.send("server", "present", {{"seat", 1}}), "");
  } else if (event == "restart") {
    play.restart();
  } else if (event == "away") {
    EXPECT_EQ(play.send("server", "away", {{"seat", 1}}), "");
    play.wait(30);
    EXPECT_EQ(play.send("server", "present", {{"seat", 1}}), "");
  } else if (event == "leave") {
    EXPECT_EQ(play.seat(1, "leave"), "");
  }
  return true;
}

// People, with one simulated learner in a group, to the end.
void teach_people(const Combination& row, Play& play, std::size_t people) {
  watch(row, play);
  play.start(people);
  bool has_happened = false;
  const auto is_over = [&] {
    for (std::size_t seat = 1; seat <= people; ++seat) {
      if (!play.room().is_done(seat)) return false;
    }
    return true;
  };
  for (std::size_t i = 0; i < 400 && !is_over(); ++i) {
    for (std::size_t seat = 1; seat <= people; ++seat) {
      const auto stage = play.room().stage_of(seat);
      if (stage == "discuss") {
        EXPECT_EQ(play.discuss(seat, (seat + i) % 2 == 0), "");
      } else if (stage == "questions") {
        EXPECT_EQ(play.seat(seat, "questions", {{"answers", {{"a", 4}}}}), "");
      } else {
        play.act(seat, (seat + i) % 3 != 0);
      }
    }
    if (play.room().stage() == RoomStage::kRunning && !has_happened) has_happened = happens(row, play);
  }
  EXPECT_TRUE(is_over());
  expect_same_figures(play);
  play.expect_replay();  // with nobody who looks
}

void teach_room(const Combination& row, const std::shared_ptr<const LiveStudy>& study) {
  const auto cell = live_cells(*study).front();
  std::vector<bool> simulated(cell.composition.size(), false);
  if (simulated.size() > 1) simulated.back() = true;
  Play play{study, RoomSetup{.id = "r1",
                             .code = "c",
                             .strategy = cell.strategy,
                             .composition = cell.composition,
                             .simulated = simulated,
                             .salt = "salt"}};
  teach_people(row, play, std::max<std::size_t>(simulated.size() - 1, 1));
}

// The engine of lesson pages, which is asked what a room was asked, and has to answer the same.
class AskedEngine {
 public:
  AskedEngine(const Combination& row, const Json& document, std::int64_t now_us) : row_{row}, now_us_{now_us} {
    open_ = {{"do", "open"}, {"inputs", document.at("inputs")}, {"setup", document.at("setup")}, {"now_us", now_us}};
    hear(ask(open_));
  }
  void send(const RoomCommand& command) {
    if (command.actor == "server" && command.type == "present" && row_[kEvent] == "restart") open_again();
    if (command.actor == "server") return;  // the page does so when it opens
    const auto reply = ask({{"do", "ask"}, {"type", command.type}, {"body", command.body}, {"now_us", now_us_}});
    EXPECT_TRUE(reply.at("refusal").is_null()) << reply.at("refusal");
    hear(reply);
    if (row_[kWatch] != "facilitator") return;
    EXPECT_FALSE(ask({{"do", "teacher"}}).at("periods").empty());
  }
  [[nodiscard]] const Json& events() const { return events_; }

 private:
  static Json ask(const Json& request) {
    auto reply = Json::parse(kith_engine(request.dump().c_str()));
    EXPECT_FALSE(reply.contains("error")) << reply.dump();
    return reply;
  }
  void hear(Json reply) {
    for (;;) {
      for (const auto& event : reply.at("events")) events_.push_back(event);
      if (!reply.at("teaching").get<bool>()) return;
      reply = ask({{"do", "teach"}, {"now_us", now_us_}});
    }
  }
  // Lessons are chosen again.
  void open_again() {
    auto open = open_;
    open["events"] = events_;
    for (auto& event : open["events"]) {
      if (event.at("type") == happening::LessonChosen::kKind.word) event["body"] = nullptr;
    }
    const auto reply = ask(open);
    EXPECT_EQ(reply.at("restored").at("events"), events_);
    hear(reply);
  }

  const Combination& row_;
  std::int64_t now_us_;
  Json open_;
  Json events_ = Json::array();
};

// One person, from the document that a page carries.
void teach_lesson(const Combination& row, const SessionStudy& session) {
  const auto document = lesson_document(session, "kith test");
  const auto restored = restore_session_study(document.at("inputs").get<std::map<std::string, std::string>>());
  EXPECT_EQ(restored.digest, session.digest);
  auto setup = document;
  setup["setup"]["id"] = "somebody";
  Play play{restored.study, room_setup(setup.at("setup"))};
  const auto start = play.now();
  teach_people(row, play, 1);
  if (row[kMedium] != "lesson-engine") return;
  AskedEngine engine{row, setup, start};
  for (const auto& command : play.commands()) engine.send(command);
  Json events = Json::array();
  for (const auto& event : play.events()) events.push_back(to_json(event));
  EXPECT_EQ(engine.events(), events);
}

// A team of simulated learners, and a room of them where people could be taught so.
void simulate(const Combination& row, const Study& study, const std::shared_ptr<const Atlas>& atlas) {
  const auto& spec = study.variants.front();
  TeamAddress address;
  address.strategy = row[kStrategy];
  address.composition = spec.compositions.front();
  address.replicate = 1;
  TeachingCache cache{atlas};
  LastSession last;
  const auto record = run_team(*atlas, cache, spec, address, &last);
  ASSERT_TRUE(last.end);
  EXPECT_GE(record.periods, 1u);
  if (row[kRelease] != "none" || find_strategy_kind(row[kStrategy])->needs_truth || row[kStrategy] == "baseline")
    return;

  const auto live = make_live_study(study, atlas);
  if (live->atlas != atlas) return;  // people are asked less, since they could not answer everything
  Play play{live, RoomSetup{.id = "r1",
                            .code = "c",
                            .strategy = address.strategy,
                            .composition = address.composition,
                            .simulated = std::vector<bool>(address.composition.size(), true)}};
  play.settle();
  EXPECT_EQ(play.room().stage(), RoomStage::kEnded);
  EXPECT_EQ(digest_of(play.room().session()), digest_of(*last.end));
  expect_same_figures(play);
}

void teach(const Combination& row, std::size_t number) {
  const ScratchFolder folder;
  const auto text = study_text(row, domain_file(folder, row[kDomain]), number);
  const auto reading = parse_study(text, "study.toml", {.overrides = {}, .folder = folder.path()});
  ASSERT_TRUE(reading.study) << to_text(reading.diagnostics.front());
  if (row[kMedium] == "study") return simulate(row, *reading.study, std::make_shared<const Atlas>(*reading.domain));
  const auto session = make_session_study(reading, folder.path());
  if (row[kMedium] == "live") return teach_room(row, session.study);
  teach_lesson(row, session);
}

// Every so many rows, from that one on.
void teach_every(std::size_t step, std::size_t first) {
  const auto& array = pairs();
  const auto& factors = array.factors();
  for (std::size_t number = first; number < array.rows().size(); number += step) {
    Combination row;
    std::string name;
    for (std::size_t f = 0; f < factors.size(); ++f) {
      row.what[f] = factors[f].levels[array.rows()[number][f]];
      name += (f > 0 ? ", " : "") + factors[f].name + " " + row.what[f];
    }
    SCOPED_TRACE(std::to_string(number) + ": " + name);
    EXPECT_NO_THROW(teach(row, number));
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(Pairs, OfAllThatCanBeCombinedAreInTheArray) {
  const auto& array = pairs();
  std::set<std::pair<Level, Level>> met;
  for (const auto& row : array.rows()) {
    for (std::size_t f = 0; f < row.size(); ++f) {
      for (std::size_t g = f + 1; g < row.size(); ++g) {
        const Level a{f, row[f]}, b{g, row[g]};
        EXPECT_TRUE(array.can_combine(a, b));
        met.emplace(a, b);
      }
    }
  }
  EXPECT_EQ(met.size(), array.num_pairs());
}

TEST(Pairs, WorkTogetherInAFifthOfTheSessions) { teach_every(5, 3); }

TEST(PairsSlow, WorkTogetherInAllSessions) { teach_every(1, 0); }

}  // namespace
}  // namespace kith::laws
