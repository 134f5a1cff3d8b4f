#include "world_book.hpp"

#include <algorithm>

#include "json_int.hpp"
#include "kith/explain/json.hpp"

namespace kith {
namespace {

// Empty where something is no state.
std::optional<std::vector<std::vector<int>>> read_moves(const Json& json) {
  if (!json.is_array()) return std::nullopt;
  std::vector<std::vector<int>> moves;
  for (const auto& state : json) {
    if (!state.is_array()) return std::nullopt;
    auto& to = moves.emplace_back();
    for (const auto& next : state) {
      const auto number = int_of(next);
      if (!number) return std::nullopt;
      to.push_back(*number);
    }
  }
  return moves;
}

}  // namespace

std::optional<std::vector<int>> WorldTable::shortest_path(int start) const {
  const auto size = next.size();
  const auto first = static_cast<std::size_t>(start);
  if (start < 0 || first >= size || is_end.size() != size) return std::nullopt;
  constexpr int kUnseen = -1;
  std::vector<int> action_to(size, kUnseen), state_before(size, kUnseen);
  std::deque<std::size_t> open{first};
  std::vector<bool> seen(size, false);
  seen[first] = true;
  while (!open.empty()) {
    const auto state = open.front();
    open.pop_front();
    if (is_end[state]) {
      std::vector<int> path;
      for (auto at = state; at != first; at = static_cast<std::size_t>(state_before[at])) path.push_back(action_to[at]);
      std::reverse(path.begin(), path.end());
      return path;
    }
    for (std::size_t action = 0; action < next[state].size(); ++action) {
      const int to = next[state][action];
      if (to < 0 || static_cast<std::size_t>(to) >= size || seen[static_cast<std::size_t>(to)]) continue;
      seen[static_cast<std::size_t>(to)] = true;
      action_to[static_cast<std::size_t>(to)] = static_cast<int>(action);
      state_before[static_cast<std::size_t>(to)] = static_cast<int>(state);
      open.push_back(static_cast<std::size_t>(to));
    }
  }
  return std::nullopt;
}

std::optional<WorldTable> read_world_table(const std::string& json) try {
  const auto document = Json::parse(json);
  auto moves = read_moves(document.at("next"));
  if (!moves) return std::nullopt;
  return WorldTable{.next = std::move(*moves), .is_end = document.at("end").get<std::vector<bool>>()};
} catch (const Json::exception&) {
  return std::nullopt;
}

WorldBook::WorldBook(Fetch fetch) : fetch_{std::move(fetch)}, thread_{[this] { work(); }} {}

WorldBook::~WorldBook() {
  {
    const std::lock_guard lock{mutex_};
    is_stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::shared_ptr<const WorldTable> WorldBook::find(const std::string& key, const std::string& token,
                                                  std::function<void()> is_ready) {
  const std::lock_guard lock{mutex_};
  const auto found = worlds_.find(key);
  if (found != worlds_.end()) return found->second;
  auto& waiting = waiting_[key];
  if (waiting.empty()) wanted_.emplace_back(key, token);
  waiting.push_back(std::move(is_ready));
  changed_.notify_one();
  return nullptr;
}

void WorldBook::work() {
  std::unique_lock lock{mutex_};
  for (;;) {
    changed_.wait(lock, [this] { return is_stopped_ || !wanted_.empty(); });
    if (is_stopped_) return;
    const auto [key, token] = std::move(wanted_.front());
    wanted_.pop_front();
    lock.unlock();
    const auto body = fetch_(key, token);
    auto table = body ? read_world_table(*body) : std::nullopt;
    lock.lock();
    worlds_[key] = std::make_shared<const WorldTable>(table ? *std::move(table) : WorldTable{});
    const auto ready = std::move(waiting_[key]);
    waiting_.erase(key);
    lock.unlock();
    for (const auto& call : ready) call();
    lock.lock();
  }
}

}  // namespace kith
