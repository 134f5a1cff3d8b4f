// People with browsers, simulated, over the real protocol: three are screened and seated, one leaves, and a fourth from
// the waiting list takes over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/executor_work_guard.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "bot.hpp"
#include "kith/core/error.hpp"
#include "kith/server/server.hpp"
#include "kith/service/live_service.hpp"
#include "kith/store/session_review.hpp"
#include "kith/store/session_study.hpp"
#include "kith/study/study_file.hpp"
#include "raw_web_socket.hpp"
#include "scratch_folder.hpp"
#include "study_texts.hpp"

namespace kith::testing {
namespace {

using Json = nlohmann::json;

// Everybody who answers the screening alike fits every place of a group.
SessionStudy study_with_replacements() {
  const std::string text =
      "schema = \"kith.study/1\"\nid = \"takeover\"\ndomain = \"item-delivery\"\nseed = 7\nreplicates = 3\n[design]\n"
      "strategies = [\"common\"]\ncompositions = [\"NNN\", \"PPP\"]\n" +
      kPaperLearners +
      "[teacher]\ncounterfactuals = 4\nparticles = 100\n[group]\nscreening = { tests = 2, high = \"P\" }\n"
      "dropout = { policy = \"replace-from-pool\", grace_s = 3600 }\n";
  const auto reading = parse_study(text, "takeover.toml");
  if (!reading.study) throw Error{reading.diagnostics};
  return make_session_study(reading);
}

// A server with a study, and whoever comes.
class Hall {
 public:
  Hall() : service_{study_.study, options()}, server_{{}, service_} { service_.set_base_url("http://localhost"); }
  ~Hall() {
    for (const auto& person : people_) person->stop();
    wait_until([this] { return world_.unfinished == 0; });
    io_.stop();
  }
  Hall(const Hall&) = delete;
  Hall& operator=(const Hall&) = delete;

  // The token of somebody who comes by the link of the study.
  [[nodiscard]] std::string join() const {
    const auto body = Json{{"code", code()}}.dump();
    const auto reply = ask(server_.port(),
                           "POST /api/join HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json"
                           "\r\nContent-Length: " +
                               std::to_string(body.size()) + "\r\n\r\n" + body);
    return Json::parse(reply.body).value("token", "");
  }
  Bot& come(const std::string& token) {
    ++world_.unfinished;
    ++group_->unfinished;
    people_.push_back(std::make_shared<Bot>(io_, world_, group_, token, people_.size() + 1));
    people_.back()->start();
    return *people_.back();
  }
  [[nodiscard]] std::size_t num_unfinished() const { return world_.unfinished; }
  [[nodiscard]] std::vector<StoredEvent> events(const std::string& type) const {
    std::vector<StoredEvent> found;
    auto file = EventFile::read(scratch_ / "live");
    file.for_each_event([&](const StoredEvent& event) {
      if (event.type == type) found.push_back(event);
    });
    return found;
  }
  [[nodiscard]] std::string problem_of_replay() const {
    auto file = EventFile::read(scratch_ / "live");
    TeachingCache cache{study_.study->atlas};
    std::string problem;
    for (const auto& room : file.rooms()) problem += replay_room(file, room, study_.study, cache).problem;
    return problem;
  }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] LiveService& service() { return service_; }
  // The threads of the bots have nothing to do any more: their records can be read.
  void end() {
    io_.stop();
    threads_.clear();
  }

  // @return false after two minutes.
  static bool wait_until(const std::function<bool()>& is_so) {
    for (int i = 0; i < 12'000; ++i) {
      if (is_so()) return true;
      usleep(10'000);
    }
    return false;
  }

 private:
  [[nodiscard]] LiveServiceOptions options() const {
    LiveServiceOptions options;
    options.folder = scratch_ / "live";
    options.inputs = study_.inputs;
    options.digest = study_.digest;
    options.program = "kith test";
    options.teaching_workers = 1;
    return options;
  }
  // As facilitators see it.
  [[nodiscard]] std::string code() const {
    RawWebSocket facilitator{server_.port()};
    facilitator.say(Json{{"t", "hello"}, {"v", 1}, {"token", facilitator_}}.dump());
    for (int i = 0; i < 20; ++i) {
      const auto frame = Json::parse(facilitator.hear(), nullptr, false);
      if (frame.is_object() && frame.contains("view")) return frame["view"]["links"].value("code", "");
    }
    return {};
  }

  ScratchFolder scratch_;
  SessionStudy study_ = study_with_replacements();
  LiveService service_;
  Server server_;
  std::string facilitator_ = service_.start_links().facilitator;
  asio::io_context io_;
  RehearsalOptions how_{.facilitator = {}, .answer_every = std::chrono::milliseconds{20}};
  tcp::endpoint address_{asio::ip::make_address("127.0.0.1"), server_.port()};
  WorldBook book_{[this](const std::string& key, const std::string& token) {
    return http_get(address_, "/api/world/" + key, token);
  }};
  BotWorld world_{.options = how_, .server = address_, .book = book_};
  std::shared_ptr<BotGroup> group_ = std::make_shared<BotGroup>();
  std::vector<std::shared_ptr<Bot>> people_;
  asio::executor_work_guard<asio::io_context::executor_type> work_{io_.get_executor()};
  std::vector<std::jthread> threads_ = [this] {
    std::vector<std::jthread> threads;
    threads.emplace_back([this] { io_.run(); });
    return threads;
  }();
};

TEST(TakeoverOverTheWire, TeachesWhoeverTakesOverToTheEnd) {
  Hall hall;
  std::vector<std::string> tokens;
  for (int i = 0; i < 4; ++i) tokens.push_back(hall.join());
  ASSERT_THAT(tokens, ::testing::Each(::testing::Not("")));
  std::vector<Bot*> bots;
  for (int i = 0; i < 3; ++i) bots.push_back(&hall.come(tokens[static_cast<std::size_t>(i)]));
  ASSERT_TRUE(Hall::wait_until([&] { return hall.service().num_rooms() == 1; }));
  bots[0]->stop();  // the group waits for this person now
  bots.push_back(&hall.come(tokens[3]));
  ASSERT_TRUE(Hall::wait_until([&] { return hall.events("screened").size() == 8; }));

  RawWebSocket leaver{hall.port()};
  leaver.say(Json{{"t", "hello"}, {"v", 1}, {"token", tokens[0]}}.dump());
  leaver.say(R"({"t":"leave","id":"goodbye","body":{}})");
  std::string heard;
  for (int i = 0; i < 10 && heard.find("\"ack\"") == std::string::npos; ++i) heard = leaver.hear();
  EXPECT_THAT(heard, ::testing::HasSubstr("goodbye"));

  ASSERT_TRUE(Hall::wait_until([&] { return hall.num_unfinished() == 0; }));
  hall.end();
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(bots[i]->record().stage, "debrief") << i;
  EXPECT_GT(bots[3]->record().answers.size(), 0u);
  ASSERT_EQ(hall.events("called").size(), 1u);
  const auto left = hall.events("left");
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(Json::parse(left.front().json)["by"], 4);
  EXPECT_EQ(left.front().message, "goodbye");
  EXPECT_EQ(hall.problem_of_replay(), "");
}

}  // namespace
}  // namespace kith::testing
