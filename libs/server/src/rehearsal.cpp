#include "kith/server/rehearsal.hpp"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <thread>
#include <utility>

#include "bot.hpp"
#include "bot_facilitator.hpp"
#include "kith/core/error.hpp"
#include "latencies.hpp"
#include "worker_pool.hpp"

namespace kith {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kPollTime{100};
constexpr milliseconds kTimeToEnd{20'000};

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

RehearsalResult result_of(const std::vector<std::shared_ptr<Bot>>& bots) {
  RehearsalResult result;
  std::vector<double> acknowledgements, lessons, reconnects;
  for (const auto& bot : bots) {
    const auto& record = bot->record();
    append(acknowledgements, record.acknowledgements);
    append(lessons, record.next_lessons);
    append(reconnects, record.reconnects);
    result.messages += record.messages;
    result.reconnects += record.num_reconnects;
    result.connections_lost += record.connections_lost;
    result.unanswered += record.waits_for_answer;
    for (const auto& [reason, count] : record.refusals) {
      result.refused += count;
      result.refusals[reason] += count;
    }
    ++result.stages[record.stage.empty() ? "none" : record.stage];
    result.answers.insert(result.answers.end(), record.answers.begin(), record.answers.end());
  }
  result.people = bots.size();
  result.acknowledgement = summarised(std::move(acknowledgements));
  result.next_lesson = summarised(std::move(lessons));
  result.reconnect = summarised(std::move(reconnects));
  return result;
}

// Threads that run handlers, until it is destroyed.
class Handlers {
 public:
  Handlers(asio::io_context& io, std::size_t threads)
      : io_{io}, work_{io.get_executor()}, threads_{start_threads(threads, [&io] { io.run(); })} {
    if (threads_.empty()) throw Error{ErrorKind::kIo, "the system grants no thread for a rehearsal"};
  }
  ~Handlers() {
    io_.stop();
    threads_.clear();
  }
  Handlers(const Handlers&) = delete;
  Handlers& operator=(const Handlers&) = delete;

 private:
  asio::io_context& io_;
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  std::vector<std::jthread> threads_;
};

}  // namespace

std::size_t RehearsalResult::num_finished() const {
  std::size_t finished = 0;
  for (const auto& [stage, count] : stages) finished += is_last_stage(stage) ? count : 0;
  return finished;
}

RehearsalResult rehearse(const RehearsalOptions& options) {
  NetError error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error) throw Error{ErrorKind::kUsage, "'" + options.address + "' is no IP address"};
  const tcp::endpoint server{address, options.port};

  WorldBook book{[server](const std::string& key, const std::string& token) {
    return http_get(server, "/api/world/" + key, token);
  }};
  asio::io_context io;
  BotWorld world{.options = options, .server = server, .book = book};
  std::vector<std::shared_ptr<Bot>> bots;
  Clock::time_point start;
  RehearsalResult result;
  {
    Handlers handlers{io, std::max<std::size_t>(options.threads, 1)};
    BotFacilitator facilitator{io, server, options.facilitator};
    const auto rooms = facilitator.make_rooms(options.groups, options.people, options.strategy);
    std::uint64_t seed = options.seed;
    for (const auto& room : rooms) {
      const auto group = std::make_shared<BotGroup>();
      for (const auto& token : room.tokens) bots.push_back(std::make_shared<Bot>(io, world, group, token, ++seed));
    }
    world.unfinished = bots.size();
    start = Clock::now();
    for (const auto& bot : bots) bot->start();

    const auto wait = [&](auto&& goes_on) {
      while (world.unfinished > 0 && goes_on(std::chrono::duration_cast<milliseconds>(Clock::now() - start))) {
        std::this_thread::sleep_for(kPollTime);
      }
    };
    bool is_stopped = false;
    wait([&](milliseconds elapsed) {
      is_stopped = options.on_tick && !options.on_tick(elapsed);
      return !is_stopped && (options.duration.count() == 0 || elapsed < options.duration);
    });
    result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (!is_stopped && world.unfinished > 0) {
      // Another connection: the first may not have survived, for instance because the server was restarted.
      BotFacilitator{io, server, options.facilitator}.end_rooms(rooms);
      const auto ended = Clock::now();
      wait([&](milliseconds) { return Clock::now() - ended < kTimeToEnd; });
    }
    for (const auto& bot : bots) bot->stop();
    wait([stopped = Clock::now()](milliseconds) { return Clock::now() - stopped < std::chrono::seconds{5}; });
    result.groups = rooms.size();
  }
  auto summary = result_of(bots);
  summary.groups = result.groups;
  summary.seconds = result.seconds;
  return summary;
}

}  // namespace kith
