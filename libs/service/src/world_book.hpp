#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace kith {

/// The table of moves of a world, as GET /api/world/KEY tells it.
struct WorldTable {
  std::vector<std::vector<int>> next;  ///< Per state and action the next state, or -1.
  std::vector<bool> is_end;

  /// The fewest actions from `start` to an end; nothing if there is no way.
  [[nodiscard]] std::optional<std::vector<int>> shortest_path(int start) const;
};

/// @return nothing if the text is no such table.
[[nodiscard]] std::optional<WorldTable> read_world_table(const std::string& json);

/// The worlds that the people of a rehearsal have seen. Fetched once for all of them, by a thread of its own, so that
/// nobody's messages wait for it.
class WorldBook {
 public:
  /// @param fetch  the body of GET /api/world/KEY with this token, or nothing.
  using Fetch = std::function<std::optional<std::string>(const std::string& key, const std::string& token)>;

  explicit WorldBook(Fetch fetch);
  ~WorldBook();
  WorldBook(const WorldBook&) = delete;
  WorldBook& operator=(const WorldBook&) = delete;

  /// The world, or null if it is not there yet: it is fetched then, and `is_ready` called from another thread. A world
  /// that cannot be fetched is an empty table.
  [[nodiscard]] std::shared_ptr<const WorldTable> find(const std::string& key, const std::string& token,
                                                       std::function<void()> is_ready);

 private:
  void work();

  Fetch fetch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopped_ = false;
  std::map<std::string, std::shared_ptr<const WorldTable>> worlds_;
  std::map<std::string, std::vector<std::function<void()>>> waiting_;
  std::deque<std::pair<std::string, std::string>> wanted_;
  std::thread thread_;
};

}  // namespace kith
