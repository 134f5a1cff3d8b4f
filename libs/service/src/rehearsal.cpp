#include "kith/service/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "bot.hpp"
#include "bot_facilitator.hpp"
#include "kith/core/error.hpp"
#include "latencies.hpp"
#include "threads.hpp"

namespace kith {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kPollTime{100};
constexpr std::size_t kPollsPerLook = 3;
constexpr milliseconds kTimeToEnd{20'000};
constexpr milliseconds kTimeToStop{5'000};

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

// The groups of a rehearsal and the people in them.
class Groups {
 public:
  Groups(Threads& threads, const tcp::endpoint& server, const RehearsalOptions& options)
      : threads_{threads}, server_{server}, options_{options}, world_{.options = options, .server = server} {
    facilitator_.emplace(threads_.io(), server_, options_.facilitator);
    add(options_.groups);
  }
  ~Groups() { threads_.stop(); }
  Groups(const Groups&) = delete;
  Groups& operator=(const Groups&) = delete;

  [[nodiscard]] std::size_t num_unfinished() const { return world_.unfinished; }
  [[nodiscard]] std::size_t size() const { return groups_.size(); }
  [[nodiscard]] const std::vector<std::shared_ptr<Bot>>& people() const { return people_; }

  // A new group for every one that has finished.
  void replace_finished() {
    const auto unfinished = static_cast<std::size_t>(
        std::count_if(groups_.begin(), groups_.end(), [](const Group& group) { return group.shared->unfinished > 0; }));
    if (unfinished >= options_.groups) return;
    try {
      if (!facilitator_) facilitator_.emplace(threads_.io(), server_, options_.facilitator);
      add(options_.groups - unfinished);
    } catch (const Error&) {
      facilitator_.reset();  // the server was restarted: once more, over a new connection
    }
  }
  // Whoever looks goes from group to group; a page whose connection has ended is opened again.
  void look() {
    if (options_.observer.empty() || num_polls_++ % kPollsPerLook != 0) return;
    const auto& room = groups_[num_looks_++ % groups_.size()].room.id;
    for (std::size_t i = 0; i < watchers_.size(); ++i) {
      auto& watcher = watchers_[i];
      if (!watcher || watcher->is_closed()) {
        watcher.emplace(threads_.io(), server_, i == 0 ? options_.facilitator : options_.observer);
      }
      watcher->look_at(room);
      for (auto& problem : watcher->problems()) problems_.insert(std::move(problem));
    }
  }
  [[nodiscard]] const std::set<std::string>& problems() const { return problems_; }
  void end() {
    std::vector<BotFacilitator::Room> rooms;
    for (const auto& group : groups_) {
      if (group.shared->unfinished > 0) rooms.push_back(group.room);
    }
    // Another connection: the first may not have survived, for instance because the server was restarted.
    BotFacilitator{threads_.io(), server_, options_.facilitator}.end_rooms(rooms);
  }
  void stop() {
    for (const auto& person : people_) person->stop();
  }

 private:
  struct Group {
    BotFacilitator::Room room;
    std::shared_ptr<BotGroup> shared;
  };

  void add(std::size_t count) {
    std::set<std::string> earlier;
    for (const auto& group : groups_) earlier.insert(group.room.id);
    for (auto& room : facilitator_->make_rooms(count, std::move(earlier))) {
      const auto shared = std::make_shared<BotGroup>();
      shared->unfinished = room.tokens.size();
      world_.unfinished += room.tokens.size();
      for (const auto& token : room.tokens) {
        people_.push_back(std::make_shared<Bot>(threads_.io(), world_, shared, token, ++seed_));
        people_.back()->start();
      }
      groups_.push_back({std::move(room), shared});
    }
  }

  Threads& threads_;
  tcp::endpoint server_;
  const RehearsalOptions& options_;
  BotWorld world_;
  std::uint64_t seed_ = 1;
  std::optional<BotFacilitator> facilitator_;
  std::vector<Group> groups_;
  std::vector<std::shared_ptr<Bot>> people_;
  std::array<std::optional<BotFacilitator>, 2> watchers_;  // a facilitator and an observer
  std::size_t num_polls_ = 0, num_looks_ = 0;
  std::set<std::string> problems_;
};

}  // namespace

std::size_t RehearsalResult::num_finished() const {
  std::size_t finished = 0;
  for (const auto& [stage, count] : stages) finished += is_last_stage(stage) ? count : 0;
  return finished;
}

RehearsalResult rehearse(const RehearsalOptions& options) {
  const tcp::endpoint server{asio::ip::address_v4::loopback(), options.port};
  const bool is_timed = options.duration.count() > 0;

  Threads threads{1};
  Groups groups{threads, server, options};
  const auto start = Clock::now();
  const auto wait = [&](auto&& goes_on) {
    while (goes_on(std::chrono::duration_cast<milliseconds>(Clock::now() - start))) {
      std::this_thread::sleep_for(kPollTime);
    }
  };
  bool is_stopped = false;
  wait([&](milliseconds elapsed) {
    is_stopped = options.on_tick && !options.on_tick(elapsed);
    if (is_stopped) return false;
    groups.look();
    if (!is_timed) return groups.num_unfinished() > 0;
    if (elapsed >= options.duration) return false;
    groups.replace_finished();
    return true;
  });
  const auto seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const auto wait_for_all = [&](milliseconds patience) {
    const auto from = Clock::now();
    wait([&](milliseconds) { return groups.num_unfinished() > 0 && Clock::now() - from < patience; });
  };
  if (!is_stopped && groups.num_unfinished() > 0) {
    groups.end();
    wait_for_all(kTimeToEnd);
  }
  groups.stop();
  wait_for_all(kTimeToStop);
  threads.stop();

  auto result = result_of(groups.people());
  result.groups = groups.size();
  result.problems = groups.problems();
  result.seconds = seconds;
  return result;
}

}  // namespace kith
