// kith serve: how it starts, what it prints, how it stops. What it serves is tested in libs/service.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <optional>

#include "kith/service/rehearsal.hpp"
#include "kith/store/event_file.hpp"
#include "run_kith.hpp"
#include "slow_study.hpp"

namespace kith::testing {
namespace {

using ::testing::MatchesRegex;
using ::testing::SizeIs;
using ::testing::StartsWith;

// The answer to a request, whole; empty if there is none.
std::string ask_port(int port, const std::string& path) {
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    const auto request = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    static_cast<void>(send(client, request.data(), request.size(), MSG_NOSIGNAL));
    char bytes[4096];
    for (ssize_t size = 0; (size = recv(client, bytes, sizeof bytes, 0)) > 0;) {
      answer.append(bytes, static_cast<std::size_t>(size));
    }
  }
  close(client);
  return answer;
}

// A server that runs until it is stopped or the test ends.
class Serving {
 public:
  explicit Serving(std::vector<std::string> arguments) {
    std::ofstream{scratch_ / "in"} << "";
    arguments.insert(arguments.begin(), "serve");
    arguments.emplace_back("--json");
    process_ = start_kith(arguments, {}, scratch_ / "in", scratch_ / "out", scratch_ / "err");
  }
  ~Serving() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    static_cast<void>(exit_code_of(process_));
  }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

  // What it prints when it is ready; nothing if it ended before.
  std::optional<Json> links() {
    for (int i = 0; i < 6000; ++i) {
      auto document = Json::parse(text_of(scratch_ / "out"), nullptr, false);
      if (document.is_object() && document.contains("port")) return document;
      int status = 0;
      if (waitpid(process_, &status, WNOHANG) != 0) {
        process_ = 0;
        return std::nullopt;
      }
      usleep(10'000);
    }
    return std::nullopt;
  }
  int stop(int signal) {
    kill(process_, signal);
    return exit_code_of(std::exchange(process_, 0));
  }
  [[nodiscard]] std::string log() const { return text_of(scratch_ / "err"); }

 private:
  Scratch scratch_;
  pid_t process_ = 0;
};

bool has_pages() {
  return run_kith({"serve", "quick"}).err.find("without pages") == std::string::npos &&
         run_kith({"serve", "--demo", "--bind", "nowhere"}).err.find("without pages") == std::string::npos;
}

TEST(ServeCommand, RefusesOptionsThatContradictEachOther) {
  const std::vector<std::vector<std::string>> wrong{
      {"serve"},
      {"serve", "quick", "--demo"},
      {"serve", "quick"},
      {"serve", "quick", "-o", "x", "--no-browser"},
      {"serve", "quick", "-o", "x", "--for", "3"},
      {"serve", "quick", "-o", "x", "--port", "70000"},
      {"serve", "quick", "--rehearse", "0"},
      {"serve", "quick", "--rehearse", "2", "--answer-every", "0"},
      {"serve", "quick", "--rehearse", "2", "--for", "3", "--restart-after", "3"},
      {"serve", "quick", "-o", "x", "--restart-after", "3"},
      {"serve", "quick", "--rehearse", "2", "--lan"},
      {"serve", "quick", "--rehearse", "2", "--insecure-lan"},
      {"serve", "quick", "--rehearse", "2", "--bind", "0.0.0.0"},
      {"serve", "quick", "--rehearse", "2", "--bind", "nowhere"},
      {"serve", "quick", "--rehearse", "2", "--public-url", "study.example.org"},
      {"serve", "quick", "--rehearse", "2", "--public-url", "https://study.example.org/path"},
      {"serve", "quick", "--rehearse", "2", "--trusted-proxy", "192.0.2.1"},
      {"serve", "quick", "--rehearse", "2", "--public-url", "https://study.example.org", "--trusted-proxy", "proxy"},
      {"serve", "quick", "--rehearse", "2", "--connections-per-address", "0"},
  };
  for (const auto& arguments : wrong) {
    const auto ran = run_kith(arguments);
    EXPECT_EQ(ran.code, 2) << ::testing::PrintToString(arguments) << ran.err;
    EXPECT_EQ(ran.out, "") << ::testing::PrintToString(arguments);
  }
}

TEST(ServeCommand, SaysWhatMakesANetworkSafe) {
  const auto ran = run_kith({"serve", "quick", "--rehearse", "2", "--lan"});
  EXPECT_THAT(ran.err, AllOf(HasSubstr("answers and links would cross the network unencrypted"),
                             HasSubstr("--public-url https://"), HasSubstr("--insecure-lan")));
}

TEST(ServeCommand, ServesADemonstrationUntilItIsStopped) {
  if (!has_pages()) GTEST_SKIP() << "built without pages";
  const Scratch scratch;
  Serving serving{{"--demo", "--no-browser", "--port", "0", "-o", scratch / "live"}};
  const auto links = serving.links();
  ASSERT_TRUE(links.has_value()) << serving.log();
  const int port = links->at("port");
  const auto base = "http://127.0.0.1:" + std::to_string(port);
  EXPECT_THAT(links->at("facilitator").get<std::string>(), StartsWith(base + "/f#t="));
  EXPECT_THAT(links->at("join").get<std::string>(), StartsWith(base + "/"));
  EXPECT_THAT(links->at("code").get<std::string>(), MatchesRegex("[2-9A-Z]+"));
  ASSERT_THAT(links->at("seats"), SizeIs(3));
  EXPECT_THAT(links->at("seats")[0].get<std::string>(), StartsWith(base + "/j#t="));
  for (const char* path : {"/", "/j", "/f", "/assets/live/app.js", "/assets/facilitator/app.js", "/api/health"}) {
    EXPECT_THAT(ask_port(port, path), StartsWith("HTTP/1.1 200 ")) << path;
  }
  EXPECT_THAT(ask_port(port, "/etc/passwd"), StartsWith("HTTP/1.1 404 "));
  EXPECT_EQ(serving.stop(SIGINT), 0) << serving.log();
  EXPECT_EQ(ask_port(port, "/j"), "");

  Serving again{{"--demo", "--no-browser", "--port", "0", "-o", scratch / "live"}};
  const auto links_again = again.links();
  ASSERT_TRUE(links_again.has_value()) << again.log();
  EXPECT_EQ(links_again->at("code"), links->at("code"));
  EXPECT_NE(links_again->at("facilitator"), links->at("facilitator"));
  EXPECT_EQ(again.stop(SIGTERM), 0) << again.log();
}

TEST(ServeCommand, MakesOnlyTheRoomsThatAreMissing) {
  if (!has_pages()) GTEST_SKIP() << "built without pages";
  const Scratch scratch;
  for (const std::size_t rooms : {2U, 3U, 3U}) {
    Serving serving{{"quick", "--rooms", std::to_string(rooms), "--port", "0", "-o", scratch / "live"}};
    ASSERT_TRUE(serving.links().has_value()) << serving.log();
    EXPECT_EQ(serving.stop(SIGINT), 0) << serving.log();
    EXPECT_THAT(EventFile::read(scratch / "live").rooms(), SizeIs(rooms));
  }
}

TEST(ServeCommand, RefusesAFolderOrAPortInUse) {
  if (!has_pages()) GTEST_SKIP() << "built without pages";
  const Scratch scratch;
  Serving first{{"--demo", "--no-browser", "--port", "0", "-o", scratch / "live"}};
  const auto links = first.links();
  ASSERT_TRUE(links.has_value()) << first.log();
  expect_code(8, {"serve", "--demo", "--no-browser", "--port", "0", "-o", scratch / "live"});
  const auto port = links->at("port").dump();
  const auto busy = err_of(8, {"serve", "--demo", "--no-browser", "--port", port, "-o", scratch / "other"});
  EXPECT_THAT(busy, HasSubstr("port " + port + " of 127.0.0.1 is in use"));
  EXPECT_EQ(first.stop(SIGINT), 0);
}

// People keep what was not acknowledged and reconnect; the server rebuilds its rooms from what is on the disk.
TEST(ServeCommand, LosesNothingWhenItIsKilled) {
  if (!has_pages()) GTEST_SKIP() << "built without pages";
  const Scratch scratch;
  const auto start = [&](const std::string& port) {
    return std::make_unique<Serving>(std::vector<std::string>{"quick", "--port", port, "-o", scratch / "live"});
  };
  auto serving = start("0");
  const auto links = serving->links();
  ASSERT_TRUE(links.has_value()) << serving->log();
  const std::string facilitator = links->at("facilitator");
  const int port = links->at("port");
  bool is_killed = false;
  RehearsalOptions options{.port = static_cast<std::uint16_t>(port),
                           .facilitator = facilitator.substr(facilitator.find("#t=") + 3),
                           .groups = 4,
                           .duration = std::chrono::seconds{6},
                           .answer_every = std::chrono::milliseconds{200}};
  options.on_tick = [&](std::chrono::milliseconds elapsed) {
    if (!is_killed && elapsed > std::chrono::seconds{2}) {
      is_killed = true;
      serving->stop(SIGKILL);
      serving = start(std::to_string(port));
    }
    return true;
  };
  const auto result = rehearse(options);
  EXPECT_EQ(result.num_finished(), result.people) << ::testing::PrintToString(result.stages) << serving->log();
  EXPECT_EQ(serving->stop(SIGINT), 0) << serving->log();
  std::map<std::string, int> stored;
  auto file = EventFile::read(scratch / "live");
  file.for_each_event([&](const StoredEvent& event) {
    if (event.message && event.type == "answered") ++stored[*event.message];
  });
  EXPECT_FALSE(result.answers.empty());
  for (const auto& id : result.answers) EXPECT_EQ(stored[id], 1) << id;
}

// Nobody waits minutes for a lesson that will not be taught; what was acknowledged is on the disk.
TEST(ServeCommand, StopsWhileALessonIsBeingChosen) {
  if (!has_pages()) GTEST_SKIP() << "built without pages";
  const Scratch scratch;
  Serving serving{{slow_study(scratch, "N"), "--port", "0", "-o", scratch / "live"}};
  const auto links = serving.links();
  ASSERT_TRUE(links.has_value()) << serving.log();
  const auto has_started = [&] {
    bool started = false;
    auto file = EventFile::read(scratch / "live");
    file.for_each_event([&](const StoredEvent& event) { started = started || event.type == "started"; });
    return started;
  };
  const std::string facilitator = links->at("facilitator");
  RehearsalOptions options{.port = links->at("port").get<std::uint16_t>(),
                           .facilitator = facilitator.substr(facilitator.find("#t=") + 3),
                           .groups = 1,
                           .duration = std::chrono::seconds{60},
                           .answer_every = std::chrono::milliseconds{100}};
  options.on_tick = [&](std::chrono::milliseconds) { return !has_started(); };
  static_cast<void>(rehearse(options));
  ASSERT_TRUE(has_started()) << serving.log();
  usleep(500'000);
  EXPECT_EQ(serving.stop(SIGINT), 0);
  EXPECT_THAT(serving.log(), HasSubstr("stopped while a lesson was being chosen; every acknowledged answer is saved"));
}

TEST(ServeCommand, RehearsesWithSimulatedPeople) {
  const auto ran = run_kith({"serve", "quick", "--rehearse", "2", "--for", "4", "--answer-every", "0.3", "--reconnects",
                             "0.05", "--port", "0", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err << ran.out;
  const auto document = Json::parse(ran.out);
  EXPECT_EQ(document.at("schema"), "kith.rehearsal/1");
  EXPECT_EQ(document.at("groups"), 2);
  EXPECT_GT(document.at("answers").at("acknowledged"), 0);
  EXPECT_EQ(document.at("answers").at("lost"), 0);
  EXPECT_EQ(document.at("answers").at("stored_twice"), 0);
  EXPECT_EQ(document.at("finished"), document.at("people"));
  EXPECT_EQ(document.at("restarts"), 0);
  EXPECT_THAT(document.at("problems"), SizeIs(0)) << "of those who look";
}

TEST(ServeCommand, LosesNothingWhenARehearsalRestartsItsServer) {
  const auto ran = run_kith({"serve", "quick", "--rehearse", "3", "--for", "5", "--answer-every", "0.2", "--reconnects",
                             "0.05", "--restart-after", "2", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err << ran.out;
  const auto document = Json::parse(ran.out);
  EXPECT_EQ(document.at("restarts"), 1);
  EXPECT_GT(document.at("connections_lost"), 0);
  EXPECT_GT(document.at("answers").at("acknowledged"), 0);
  EXPECT_EQ(document.at("answers").at("lost"), 0);
  EXPECT_EQ(document.at("answers").at("stored_twice"), 0);
  EXPECT_EQ(document.at("finished"), document.at("people"));
  EXPECT_TRUE(document.at("memory_mb").contains("last_quarter"));
}

TEST(ServeCommand, SaysThatARehearsalWasOverBeforeTheRestart) {
  const auto ran = run_kith({"serve", "quick", "--set", "stop.max_periods=1", "--rehearse", "1", "--answer-every",
                             "0.05", "--restart-after", "3600"});
  EXPECT_EQ(ran.code, 6) << ran.err << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("server     not restarted"));
  EXPECT_THAT(ran.err, HasSubstr("no restart was rehearsed"));
}

}  // namespace
}  // namespace kith::testing
