#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/live_application.hpp"

namespace kith {

struct LiveStudy;
struct ServiceState;

/// How live groups are kept and served.
struct LiveServiceOptions {
  /// From which the study can be restored, and its digest: see SessionStudy. Rooms of another digest are refused.
  std::map<std::string, std::string> inputs{};
  std::string digest{};
  std::filesystem::path folder{};                   ///< Where the store is; made if it does not exist.
  std::string program = "kith";                     ///< Name and version, told to clients and written into the store.
  std::size_t teaching_workers = 2;                 ///< Threads that choose lessons, >= 1.
  std::size_t cache_bytes = std::size_t{24} << 20;  ///< What each of them remembers, see TeachingCache.
  std::size_t joins_per_minute = 120;               ///< POST /api/join per address; 0: no limit.
  std::size_t wrong_codes_per_minute = 10;          ///< Of the same, with a code that does not exist; 0: no limit.
  std::size_t max_rooms = 2000;                     ///< No room is made beyond this number.
  std::int64_t token_hours = 24 * 14;               ///< How long links are valid, in hours.
  /// Microseconds since 1970; empty: the system's clock. Called from several threads.
  std::function<std::int64_t()> now_us{};
  /// Whether a thread calls tick() every 100 ms. Tests with a clock of their own call it themselves.
  bool ticks = true;
  /// Free bytes of the file system of a folder; empty: asks the system.
  std::function<std::uint64_t(const std::filesystem::path&)> free_bytes{};
};

/// Rooms of a study with people in them: kept in a store (EventStore), taught by threads of their own, shown to
/// connections. Knows nothing of networks.
///
/// A message is acknowledged, and its effect shown to anybody, only after it is on the disk. All functions may be
/// called from any thread, and those of connections and requests wait for nothing.
class LiveService final : public LiveApplication {
 public:
  /// The tokens of links for the person who started the service.
  struct StartLinks {
    std::string facilitator;  ///< Token for /f#t=...
    std::string observer;
    std::string code;  ///< For /j?code=..., of the study.
  };

  /// Opens the store, or makes a new one, and rebuilds all rooms from it.
  /// @throws kith::Error  kBusy E1610 (another process serves this folder), kMismatch E1611 (the store is of another
  /// study), E1612 (the store is damaged), kUsage E1613 (of another version of kith); kIo. A room that cannot be
  /// rebuilt as it was is left out and reported to facilitators.
  LiveService(std::shared_ptr<const LiveStudy> study, LiveServiceOptions options);
  /// As stop().
  ~LiveService() override;
  LiveService(const LiveService&) = delete;
  LiveService& operator=(const LiveService&) = delete;

  /// New tokens of a facilitator and an observer. Those given earlier stay valid until they expire or are revoked.
  [[nodiscard]] StartLinks start_links();
  /// Makes rooms as a facilitator does, and waits until they are on the disk.
  /// @param seats  "person" or a letter for each; none: as the study says. @return tokens of the people's seats.
  /// @throws kith::Error (kInfeasible) with the reason if that is refused; kIo once the service stops.
  std::vector<std::string> make_rooms(std::size_t count, const std::vector<std::string>& seats = {});
  /// All rooms but the waiting list, also those that are being rebuilt and that views do not show yet.
  [[nodiscard]] std::size_t num_rooms() const;
  /// Sessions in memory, which is what most of it is for: those of rooms whose group is or will be taught, and those of
  /// lessons that were chosen ahead of time. Rooms that have ended have none.
  [[nodiscard]] std::size_t num_sessions() const;
  /// How links begin, such as "http://127.0.0.1:8080"; views show them so.
  void set_base_url(std::string url);

  // --- connections and requests ---------------------------------------------
  /// A new connection. It is told nothing until its first frame is a valid hello.
  [[nodiscard]] ConnectionId open(std::shared_ptr<Socket> socket, std::string remote = {}) override;
  /// Never throws for what is in it.
  void receive(ConnectionId id, std::string_view text) override;
  /// For facilitators.
  void measured(ConnectionId id, std::chrono::microseconds round_trip) override;
  void closed(ConnectionId id) override;
  /// Everything below /api. Never throws for what is in the request.
  void http(HttpRequest request, HttpAnswer answer) override;

  // --- time -----------------------------------------------------------------
  /// Does what is due by the clock: people become away, time limits end, messages that could not be saved are tried
  /// again. Called by a thread of the service unless LiveServiceOptions::ticks is false.
  void tick();
  /// Waits until nothing is being saved, taught or sent. For tests and for stop().
  void settle();
  /// Says goodbye to all connections ("server-stops"), saves what is left and ends all threads. Further calls of
  /// receive() do nothing. May be called twice.
  void stop();

 private:
  std::unique_ptr<ServiceState> state_;
};

}  // namespace kith
