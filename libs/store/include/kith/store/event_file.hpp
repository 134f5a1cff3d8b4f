#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kith {

/// Something that happened in a room, as it is kept. Room 0 is the service itself: its events are the log of what the
/// facilitator did outside of rooms.
struct StoredEvent {
  std::int64_t room = 0;
  std::uint64_t seq = 0;  ///< From 1, without gaps within a room.
  std::int64_t at_us = 0;
  std::string actor{};
  std::string type{};
  std::string json{};
  std::optional<std::string>
      message{};  ///< Id of the message that it is the first effect of: unique per room and actor.
  friend bool operator==(const StoredEvent&, const StoredEvent&) = default;
};

/// A room. What happened in it follows from the setup and its events.
struct StoredRoom {
  std::int64_t number = 0;  ///< >= 1
  std::string setup{};      ///< JSON.
  std::int64_t created_us = 0;
  friend bool operator==(const StoredRoom&, const StoredRoom&) = default;
};

/// A link, without its secret: only the hash of the token is kept.
struct StoredToken {
  std::string hash{};  ///< SHA-256 of the token, 32 bytes.
  std::string role{};  ///< "participant", "observer" or "facilitator".
  std::int64_t room = 0;
  std::int64_t seat = 0;
  std::int64_t expires_us = 0;
  bool revoked = false;
  friend bool operator==(const StoredToken&, const StoredToken&) = default;
};

/// What is saved together or not at all.
struct StoreBatch {
  std::vector<StoredRoom> rooms{};
  std::vector<StoredToken> tokens{};   ///< New ones.
  std::vector<std::string> revoked{};  ///< Hashes of tokens.
  std::vector<StoredEvent> events{};
};

/// Whose events a file keeps.
struct StoreIdentity {
  std::string study;                          ///< Digest of what is taught: rooms of another study are not compatible.
  std::string program;                        ///< Name and version of what made the file.
  std::map<std::string, std::string> inputs;  ///< Texts of the input files by name: the file explains itself.
};

/// The name of the file in the folder of a session.
inline constexpr const char* kEventFile = "session.sqlite";
/// A copy of the identity beside it, from which a damaged file can still be read.
inline constexpr const char* kIdentityFile = "session.json";

/// The file that live sessions are kept in: an SQLite database in WAL mode, written with synchronous=FULL. Every row
/// has a checksum that is bound to the file, the room and the place in the room, so a damaged, moved or foreign row is
/// noticed. One connection; not thread-safe.
class EventFile {
 public:
  /// The number that PRAGMA user_version has in files of this version.
  static constexpr int kVersion = 1;

  /// Opens the file of a folder to write, after checking it, or makes one. A file of an earlier version is first copied
  /// to `session.sqlite.vN.bak` and then converted. The caller holds the lock of the folder.
  /// @throws kith::Error kMismatch E1611 (of another study), E1612 (damaged); kUsage E1613 (of a newer version); kIo.
  [[nodiscard]] static EventFile open(const std::filesystem::path& folder, const StoreIdentity& identity,
                                      std::int64_t now_us);
  /// Opens it to read: all that is read is of one instant, even while another process writes.
  /// @throws kith::Error kInvalidInput E1616 (the folder holds no session); as open().
  [[nodiscard]] static EventFile read(const std::filesystem::path& folder);
  /// Makes a file with that identity, id included, in an empty folder.
  [[nodiscard]] static EventFile make(const std::filesystem::path& folder, const StoreIdentity& identity,
                                      const std::string& id, std::int64_t now_us);

  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;
  EventFile(EventFile&&) noexcept;
  EventFile& operator=(EventFile&&) noexcept;
  ~EventFile();

  [[nodiscard]] const std::filesystem::path& path() const noexcept;
  [[nodiscard]] const StoreIdentity& identity() const noexcept;
  /// Tells files apart: 32 hexadecimal digits, drawn when the file was made.
  [[nodiscard]] const std::string& id() const noexcept;
  [[nodiscard]] std::int64_t created_us() const noexcept;

  // --- reading. All throw kith::Error kMismatch E1612 for a damaged row; kIo. ---
  [[nodiscard]] std::vector<StoredRoom> rooms();
  [[nodiscard]] std::vector<StoredToken> tokens();
  /// Events in order of rooms and seq; of one room if given.
  void for_each_event(const std::function<void(const StoredEvent&)>& visit, std::optional<std::int64_t> room = {});
  /// Of all rooms, or of one.
  [[nodiscard]] std::uint64_t count_events(std::optional<std::int64_t> room = {});
  /// Reads every row, and SQLite's own check. @throws kith::Error kMismatch E1612.
  void verify();

  // --- writing ----------------------------------------------------------------
  /// Saves all of them or, if it throws, none. On return everything is on the disk.
  /// @throws kith::Error (kIo), after which the file must be opened again: reopen().
  void write(std::span<const StoreBatch> batches);
  /// Replaces the texts and times of events of the same room and seq; everything else about them stays. Nothing of the
  /// old texts remains in the file. @throws kith::Error
  void rewrite(std::span<const StoredEvent> events);
  /// Closes the connection and opens another. @throws kith::Error (kIo)
  void reopen();

 private:
  struct State;
  explicit EventFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kith
