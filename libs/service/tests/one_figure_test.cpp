// What stands on several pages is the same on all of them: the facilitator's page, audits, tables, and what fits and
// reports are made of.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "kith/analysis/dataset.hpp"
#include "kith/store/session_audit.hpp"
#include "kith/store/session_review.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using testing::exported;
using testing::next_step;
using testing::Page;
using testing::ScratchFolder;
using testing::small_study;
using testing::Solver;
using testing::Stage;
using testing::stored;
using testing::three_people;
using People = std::vector<std::unique_ptr<Page>>;

constexpr std::size_t kPeriods = 3;     // that everybody finishes
constexpr std::int64_t kPredict = 120;  // seconds for the tests of a period

// What the third person does; the first is always right, the second understands nothing.
enum class Third { kLeaves, kStopsShort, kIsLate, kIsLost, kIsRight };

std::size_t round_of(const Json& view) {
  return view.contains("progress") ? view["progress"].value("round", std::size_t{0}) : std::size_t{0};
}

// Whether the person is done here.
bool act(Stage& stage, Page& person, Solver& solver, std::size_t i, Third third) {
  person.read();
  const auto& view = person.view();
  if (testing::is_terminal(person.stage()) || round_of(view) > kPeriods) return true;
  if (!person.unsaved().empty()) return false;
  auto step = next_step(view, solver, i == 0 || (i == 2 && third != Third::kIsLost));
  if (i == 2 && person.stage() == "predict" && round_of(view) >= 2) {
    if (third == Third::kIsLate) step.reset();
    if (third == Third::kLeaves) step = std::pair{std::string{"leave"}, Json::object()};
    if (third == Third::kStopsShort && view["predict"]["index"].get<std::size_t>() % 2 == 0) {
      step->second["actions"] = Json::array({step->second["actions"][0]});
      step->second["keys"] = Json::array();
    }
  }
  if (step) {
    person.ask(stage.service(), step->first, step->second);
  } else {
    person.beat(stage.service());
  }
  return false;
}

void play_periods(Stage& stage, People& people, Solver& solver, Third third) {
  for (std::size_t round = 0; round < 600; ++round) {
    bool is_over = true;
    for (std::size_t i = 0; i < people.size(); ++i) is_over = act(stage, *people[i], solver, i, third) && is_over;
    if (is_over) return;
    stage.service().settle();
    if (round % 4 == 3) stage.pass_ms(third == Third::kIsLate ? 5000 : 100);
  }
  FAIL() << "the periods do not end";
}

using Seat = std::pair<std::string, std::size_t>;  // room and seat
struct Figures {
  std::size_t tests = 0, right = 0;
  std::optional<double> knows{};
};

// Ten groups of three people who were taught with several strategies.
class OneFigure : public ::testing::Test {
 protected:
  static constexpr std::size_t kRooms = 10;

  void SetUp() override {
    auto study = small_study(
        "dropout = { policy = \"continue-now\" }\ntime = { predict_s = " + std::to_string(kPredict) + " }\n", "\"NNP\"",
        200, "\"common\", \"individual-low\", \"plan\", \"joint\", \"highlights\"");
    stage_.emplace(scratch_ / "live", std::move(study));
    Solver solver{stage_->study().study};
    const auto facilitator = stage_->facilitator();
    for (std::size_t i = 0; i < kRooms; ++i) {
      auto people = three_people(*stage_);
      const std::string room = "r" + std::to_string(i + 1);
      facilitator->ask(stage_->service(), "room-select", {{"room", room}});
      play_periods(*stage_, people, solver, static_cast<Third>(i % 5));
      // Some are over, and their sessions are released.
      if (i >= 5) facilitator->ask(stage_->service(), "end", {{"room", room}, {"reason", "a test"}});
      stage_->show(*facilitator);
      stage_->show(*facilitator);
      views_[room] = facilitator->view();
      for (auto& person : people) person->disconnect(stage_->service());
    }
    stage_->show(*facilitator);
    stage_->show(*facilitator);
    last_ = facilitator->view();
    report_ = audit_session(stored(*stage_), {.source = "live", .room = {}, .on_progress = {}}).report;
    for (const auto& person : report_.people) {
      auto& figures = audit_[{person.room, person.seat}];
      figures = {person.audit.agreement.tests, person.audit.agreement.right, person.audit.knowledge()};
    }
    tables_ = exported(*stage_);
  }

  void expect_endings() const;
  [[nodiscard]] Dataset table(const std::string& name) const { return Dataset::parse(tables_.at(name), name); }

  ScratchFolder scratch_;
  std::optional<Stage> stage_;
  std::map<std::string, Json> views_;  // of facilitators, by room
  Json last_;                          // when all is over
  AuditReport report_;
  std::map<Seat, Figures> audit_;
  std::map<std::string, std::string> tables_;
};

// How it ended for somebody is told apart everywhere.
void OneFigure::expect_endings() const {
  const auto status = [&](const Json& view, const std::string& room, std::size_t seat) {
    for (const auto& row : view.at("rooms")) {
      if (row["id"] == room) return row["seats"].at(seat - 1)["status"].get<std::string>();
    }
    return std::string{};
  };
  EXPECT_EQ(status(views_.at("r1"), "r1", 3), "left");
  EXPECT_EQ(status(views_.at("r1"), "r1", 1), "active");
  EXPECT_EQ(status(views_.at("r6"), "r6", 3), "left");
  EXPECT_EQ(status(views_.at("r6"), "r6", 1), "ended");
  const auto people = table("participants.csv");
  std::size_t gone = 0;
  for (std::size_t i = 0; i < people.num_rows(); ++i) {
    const auto room = people.cells("session")[i].value();
    const auto seat = static_cast<std::size_t>(people.numbers("seat")[i].value());
    const auto how = people.cells("status")[i].value();
    EXPECT_EQ(how, status(last_, room, seat)) << room << " " << seat;
    if (room == "r1") gone += how == "left" || how == "dropped" ? 1u : 0u;
  }
  auto file = stored(*stage_);
  const auto rooms = list_rooms(file);
  EXPECT_EQ(rooms.front().gone, gone);
  EXPECT_EQ(rooms.front().lessons, kPeriods + 1);  // one is under way
  EXPECT_EQ(rooms.at(5).ended, "a test");

  // Who needs help follows from the same judgement.
  bool is_seen = false;
  for (const auto& person : views_.at("r1")["room"]["people"]) is_seen = is_seen || person.contains("needs_help");
  EXPECT_TRUE(is_seen) << views_.at("r1")["room"]["people"];
}

TEST_F(OneFigure, StandsOnEveryPage) {
  ASSERT_EQ(audit_.size(), 3 * kRooms);
  // All answers count, those that stop short and those that were not given in time, too.
  std::size_t all = 0;
  for (const auto& person : report_.people) {
    std::size_t tests = 0, right = 0;
    for (const auto& one : person.audit.components) {
      tests += one.tests;
      right += one.correct;
    }
    EXPECT_EQ(tests, person.audit.agreement.tests);
    EXPECT_EQ(right, person.audit.agreement.right);
    all += tests;
  }

  // The facilitator's page.
  for (const auto& [room, view] : views_) {
    ASSERT_TRUE(view.contains("room") && view["room"].contains("people")) << room;
    std::set<std::size_t> seen;
    for (const auto& person : view["room"]["people"]) {
      const auto seat = person["seat"].get<std::size_t>();
      const auto& figures = audit_.at({room, seat});
      EXPECT_EQ(person["tests"], figures.tests) << room << " " << seat;
      EXPECT_EQ(person["right"], figures.right) << room << " " << seat;
      EXPECT_EQ(person["knows"], *figures.knows) << room << " " << seat;
      seen.insert(seat);
    }
    EXPECT_EQ(seen.size(), 3u) << room;
    for (const auto& row : view["rooms"]) {
      if (row["id"] != room) continue;
      for (const auto& seat : row["seats"]) {
        const auto& figures = audit_.at({room, seat["seat"].get<std::size_t>()});
        EXPECT_EQ(seat["tests"], figures.tests) << seat;
        EXPECT_EQ(seat["right"], figures.right) << seat;
      }
    }
  }

  // Tables.
  const auto people = table("participants.csv");
  const auto seats = people.numbers("seat"), tests = people.numbers("tests"), right = people.numbers("right"),
             knows = people.numbers("knowledge");
  std::map<std::string, std::pair<double, double>> of_room;  // tests and right answers
  for (std::size_t i = 0; i < people.num_rows(); ++i) {
    const auto room = people.cells("session")[i].value();
    const auto& figures = audit_.at({room, static_cast<std::size_t>(*seats[i])});
    EXPECT_EQ(*tests[i], static_cast<double>(figures.tests)) << room << " " << *seats[i];
    EXPECT_EQ(*right[i], static_cast<double>(figures.right)) << room << " " << *seats[i];
    EXPECT_NEAR(*knows[i], *figures.knows, 1e-6);
    of_room[room].first += *tests[i];
    of_room[room].second += *right[i];
  }
  const auto sessions = table("sessions.csv");
  for (std::size_t i = 0; i < sessions.num_rows(); ++i) {
    const auto room = sessions.cells("session")[i].value();
    const auto& [asked, answered] = of_room.at(room);
    EXPECT_NEAR(sessions.numbers("share_right")[i].value(), answered / asked, 1e-6) << room;
    double sum = 0.0;
    for (std::size_t seat = 1; seat <= 3; ++seat) sum += *audit_.at({room, seat}).knows;
    EXPECT_NEAR(sessions.numbers("knowledge")[i].value(), sum / 3.0, 1e-6) << room;
  }
  const auto answers = table("tests.csv");
  std::size_t judged = 0;
  for (const auto& correct : answers.numbers("correct")) judged += correct ? 1u : 0u;
  EXPECT_EQ(judged, all);

  // What fits and reports are made of.
  const auto trials = table("trials.csv");
  const auto verdicts = trials.numbers("is_opt_response");
  std::size_t fitted = 0, fitted_right = 0, all_right = 0;
  for (std::size_t i = 0; i < trials.num_rows(); ++i) {
    if (trials.cells("interaction_type")[i] != "diagnostic test") continue;
    ++fitted;
    fitted_right += verdicts[i].value() != 0.0 ? 1u : 0u;
  }
  for (const auto& [seat, figures] : audit_) all_right += figures.right;
  EXPECT_EQ(fitted, all);
  EXPECT_EQ(fitted_right, all_right);

  // Somebody who stops short or is late is not said to know more than who answered as the robot does.
  EXPECT_LT(audit_.at({"r2", 3}).right, audit_.at({"r2", 3}).tests);
  EXPECT_LT(audit_.at({"r3", 3}).right, audit_.at({"r3", 3}).tests);
  EXPECT_LT(*audit_.at({"r1", 2}).knows, 0.5) << "understands nothing";
  expect_endings();
}

}  // namespace
}  // namespace kith
