// Whoever looks changes nothing, also where there is nothing to be shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "kith/teaching/strategy.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Page;
using testing::play;
using testing::ScratchFolder;
using testing::small_study;
using testing::Solver;
using testing::Stage;
using testing::three_people;

// The study with something changed that reading it would not let through.
template <typename Change>
SessionStudy changed_study(const Change& change) {
  auto study = small_study();
  auto changed = std::make_shared<LiveStudy>(*study.study);
  change(*changed);
  study.study = std::move(changed);
  return study;
}

// A page of facilitators that looks at the first room.
std::unique_ptr<Page> watcher_of(Stage& stage) {
  auto page = stage.facilitator();
  page->ask(stage.service(), "room-select", {{"room", "r1"}});
  stage.show(*page);
  return page;
}

std::vector<std::string> problems(Stage& stage, Page& facilitator) {
  stage.show(facilitator);
  return facilitator.view().at("integrity").at("problems");
}

// Says that its lessons are for somebody whom there is not.
class OfNobody final : public Strategy {
 public:
  explicit OfNobody(std::unique_ptr<Strategy> inner) : inner_{std::move(inner)} {}
  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<OfNobody>(inner_->clone()); }
  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    auto proposal = inner_->propose(view, select, random);
    proposal.source = SourceBelief::of_member(99);
    return proposal;
  }

 private:
  std::unique_ptr<Strategy> inner_;
};

TEST(Watching, LetsEveryStrategyTeachToTheEnd) {
  for (const auto* name : {"plan", "highlights", "individual-low"}) {
    const ScratchFolder scratch;
    Stage stage{scratch / "live",
                changed_study([&](LiveStudy& study) { study.spec.strategies = {strategy_named(name)}; })};
    Solver solver{stage.study().study};
    auto people = three_people(stage);
    const auto facilitator = watcher_of(stage);
    EXPECT_TRUE(play(stage, people, solver)) << name;
    EXPECT_THAT(problems(stage, *facilitator), ::testing::IsEmpty()) << name;
  }
}

// What else a strategy could have shown is only for those who look.
TEST(Watching, DoesWithoutWhatElseCouldBeShownWhereThatCannotBeTold) {
  auto kind = strategy_named("common").kind;
  kind.make = [](const ParameterValues& values) -> std::unique_ptr<Strategy> {
    return std::make_unique<OfNobody>(strategy_named("common").kind.make(values));
  };
  const ScratchFolder scratch;
  Stage stage{scratch / "live", changed_study([&](LiveStudy& study) { study.spec.strategies.front().kind = kind; })};
  Solver solver{stage.study().study};
  auto people = three_people(stage);
  const auto facilitator = watcher_of(stage);
  EXPECT_TRUE(play(stage, people, solver));
  EXPECT_THAT(problems(stage, *facilitator), Contains(HasSubstr("does not tell what else could be shown")));
}

TEST(Watching, EndsAPageThatCannotBeShownAndNothingElse) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", changed_study([](LiveStudy& study) { study.spec.group.goal = "\xFF"; })};
  const auto facilitator = stage.facilitator();
  auto people = three_people(stage);
  for (const auto& person : people) EXPECT_EQ(person->bye(), "no-view");
  EXPECT_THAT(problems(stage, *facilitator), Contains(HasSubstr("the page of seat 2 cannot be shown: ")));
  const auto rooms = facilitator->view().at("rooms");
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_EQ(rooms[0]["stage"], "lobby");
}

TEST(Watching, TeachesARoomThatFacilitatorsCannotBeShown) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", changed_study([](LiveStudy& study) { study.imagined[{"common", "NNP"}] = {}; })};
  Solver solver{stage.study().study};
  auto people = three_people(stage);
  const auto facilitator = watcher_of(stage);
  std::vector<std::string> told;
  for (int round = 0; round < 200 && told.empty(); ++round) {
    (void)play(stage, people, solver, 4);
    told = problems(stage, *facilitator);
  }
  EXPECT_THAT(told, Contains(HasSubstr("the row cannot be shown: ")));
  EXPECT_TRUE(play(stage, people, solver));
  EXPECT_THAT(problems(stage, *facilitator), ::testing::IsEmpty()) << "it can be shown again";
}

}  // namespace
}  // namespace kith
