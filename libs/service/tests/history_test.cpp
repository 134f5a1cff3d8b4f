// Sessions of bots while everything that can go wrong does: what was acknowledged is there, once, and everybody gets to
// the end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "faulty_disk.hpp"
#include "service_support.hpp"
#include "session_history.hpp"

namespace kith {
namespace {

using testing::FaultyDisk;
using testing::is_terminal;
using ::testing::IsEmpty;
using testing::next_step;
using testing::Page;
using testing::ScratchFolder;
using testing::SessionHistory;
using testing::small_study;
using testing::Solver;
using testing::Stage;

// A study that all histories share, since it takes longer to make than to teach.
struct Shared {
  SessionStudy study = small_study(
      "dropout = { policy = \"continue-now\", grace_s = 20 }\n"
      "questions = [{ id = \"clear\", kind = \"likert\", text = \"Was it clear?\" }]\n",
      "\"NP\"", 100);
  Solver solver{study.study};
};
Shared& shared() {
  static Shared shared;
  return shared;
}

// Groups of two people with a fault now and then, all drawn from one seed.
class Tale {
 public:
  explicit Tale(unsigned seed) : random_{seed}, stage_{scratch_ / "live", shared().study} {}

  std::vector<std::string> run(std::size_t groups) {
    make_groups(groups);
    for (std::size_t round = 0; round < 1500; ++round) {
      if (round < 200) something_happens();
      if (round == 200) calm_down();
      if (act() && round > 200) break;
      stage_.service().settle();
      read_all();
      if (round % 3 == 0) stage_.pass_ms(400);
    }
    read_all();
    stage_.stop();
    auto file = EventFile::read(stage_.folder());
    return history_.check(file, stage_.study().study);
  }

  [[nodiscard]] std::size_t num_acknowledged() const { return history_.num_acknowledged(); }

 private:
  struct Client {
    std::unique_ptr<Page> page;
    std::size_t views = 0, acks = 0, naks = 0;  // of the page, that the history knows
    std::int64_t back_us = 0;                   // offline until then
  };

  std::size_t draw(std::size_t n) { return random_() % n; }

  void make_groups(std::size_t groups) {
    auto facilitator = stage_.facilitator();
    facilitator->ask(stage_.service(), "room-make", {{"count", groups}});
    stage_.show(*facilitator);
    stage_.show(*facilitator);
    for (const auto& room : facilitator->view()["rooms"]) {
      for (const auto& seat : room["seats"]) {
        const auto link = seat["link"].get<std::string>();
        const auto name = room["id"].get<std::string>() + "-" + std::to_string(seat["seat"].get<int>());
        clients_.push_back({.page = std::make_unique<Page>(link.substr(link.find("#t=") + 3), name)});
        clients_.back().page->connect(stage_.service());
        history_.group(name, room["id"].get<std::string>());
      }
    }
    facilitator->disconnect(stage_.service());
    stage_.service().settle();
    read_all();
  }

  void read_all() {
    for (auto& client : clients_) {
      auto& page = *client.page;
      page.read();
      for (; client.views < page.views().size(); ++client.views) history_.saw(page.name(), page.views()[client.views]);
      for (; client.acks < page.acks().size(); ++client.acks) history_.ok(page.acks()[client.acks]);
      for (; client.naks < page.naks().size(); ++client.naks) history_.fail(page.naks()[client.naks]);
    }
  }

  // Everybody does what the page asks for. @return whether all are done.
  bool act() {
    bool is_over = true;
    for (auto& client : clients_) {
      auto& page = *client.page;
      if (is_terminal(page.stage())) continue;
      is_over = false;
      if (!page.is_connected()) {
        if (stage_.clock().now_us() >= client.back_us) page.connect(stage_.service());
        continue;
      }
      page.beat(stage_.service());
      if (!page.unsaved().empty() || draw(3) == 0) continue;
      const auto step = next_step(page.view(), shared().solver, draw(4) != 0);
      if (!step) continue;
      const auto id = page.ask(stage_.service(), step->first, step->second);
      history_.invoke(page.name(), id, step->first, step->second);
      if (draw(6) == 0 && !page.unsaved().empty()) page.send(stage_.service(), page.unsaved().back());  // twice
    }
    return is_over;
  }

  // The nemesis.
  void something_happens() {
    auto& client = clients_[draw(clients_.size())];
    switch (draw(24)) {
      case 0:  // a connection is lost for a while
        client.page->disconnect(stage_.service());
        client.back_us = stage_.clock().now_us() + static_cast<std::int64_t>(draw(8000)) * 1000;
        break;
      case 1:  // a second tab, or a reload
        client.page->connect(stage_.service());
        break;
      case 2:  // the server ends while messages are under way
        if (draw(3) != 0) break;
        FaultyDisk::heal();
        stage_.stop();
        for (auto& other : clients_) {
          other.page->read();
          other.page->lose();
        }
        stage_.start();
        break;
      case 3:  // the disk fails for a while
        FaultyDisk::fail(1 + draw(20), 1 + draw(30),
                         draw(2) == 0 ? FaultyDisk::Fault::kFull : FaultyDisk::Fault::kShortWrite);
        break;
      case 4:
        FaultyDisk::heal();
        break;
      case 5:  // the machine sleeps
        stage_.clock().advance_ms(static_cast<std::int64_t>(draw(15'000)));
        break;
      default:
        break;
    }
  }

  void calm_down() {
    FaultyDisk::heal();
    for (auto& client : clients_) client.back_us = 0;
  }

  ScratchFolder scratch_;
  std::mt19937 random_;
  Stage stage_;
  SessionHistory history_;
  std::vector<Client> clients_;
};

void tell(unsigned first, unsigned last) {
  const FaultyDisk disk;
  for (auto seed = first; seed <= last; ++seed) {
    Tale tale{seed};
    const auto problems = tale.run(2);
    EXPECT_THAT(problems, IsEmpty()) << "seed " << seed;
    EXPECT_GT(tale.num_acknowledged(), 20u) << "seed " << seed;
  }
}

// The checker itself: what it must not overlook.
TEST(SessionHistoryChecker, FindsMessagesThatWereLostOrInvented) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", shared().study};
  Page person{stage.join(stage.join_code()), "a"};
  person.connect(stage.service());
  stage.service().settle();
  person.read();
  const auto step = next_step(person.view(), shared().solver, true);
  const auto id = person.ask(stage.service(), step->first, step->second);
  stage.service().settle();
  person.read();
  stage.stop();
  auto file = EventFile::read(stage.folder());
  SessionHistory right;
  right.invoke("a", id, step->first, step->second);
  right.ok(id);
  right.saw("a", person.view());
  EXPECT_THAT(right.check(file, stage.study().study, false), IsEmpty());
  EXPECT_THAT(right.check(file, stage.study().study), ::testing::ElementsAre("a is left in 'check'"));
  SessionHistory invented;
  EXPECT_THAT(invented.check(file, stage.study().study), ::testing::ElementsAre("stored, but never sent: " + id));
  right.invoke("a", "lost", "answer", {{"test", 0}, {"actions", {1, 2}}});
  right.ok("lost");
  EXPECT_THAT(right.check(file, stage.study().study, false),
              ::testing::ElementsAre("acknowledged, but not stored: lost"));
  SessionHistory refused;
  refused.invoke("a", id, step->first, step->second);
  refused.fail(id);
  EXPECT_THAT(refused.check(file, stage.study().study), ::testing::ElementsAre("refused, but stored: " + id));
}

class SessionHistories : public ::testing::TestWithParam<unsigned> {};
TEST_P(SessionHistories, HoldWhateverGoesWrong) { tell(GetParam(), GetParam() + 1); }
INSTANTIATE_TEST_SUITE_P(Seeds, SessionHistories, ::testing::Values(1u, 3u, 5u, 7u, 9u));

TEST(SlowSessionHistories, HoldWhateverGoesWrong) { tell(11, 110); }

}  // namespace
}  // namespace kith
