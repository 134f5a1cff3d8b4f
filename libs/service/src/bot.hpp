#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "bot_mind.hpp"
#include "client_socket.hpp"
#include "kith/explain/json.hpp"
#include "kith/service/rehearsal.hpp"
#include "net.hpp"

namespace kith {

/// What the people of a group share.
struct BotGroup {
  std::atomic<std::int64_t> last_continue_ns{0};
  std::atomic<std::size_t> unfinished{0};
};

/// What all people share.
struct BotWorld {
  const RehearsalOptions& options;
  tcp::endpoint server;
  std::atomic<std::size_t> unfinished{0};
};

/// What one person experienced.
struct BotRecord {
  std::vector<double> acknowledgements{};
  std::vector<double> next_lessons{};
  std::vector<double> reconnects{};
  std::uint64_t messages = 0;
  std::uint64_t num_reconnects = 0;
  std::uint64_t connections_lost = 0;
  std::map<std::string, std::uint64_t> refusals{};
  std::vector<std::string> answers{};
  std::string stage{};
  bool waits_for_answer = false;
};

/// One simulated person with a browser. Everything but start() and stop() happens on its strand; its record may be read
/// when the threads have ended.
class Bot : public std::enable_shared_from_this<Bot> {
 public:
  Bot(asio::io_context& io, BotWorld& world, std::shared_ptr<BotGroup> group, std::string token, std::uint64_t seed);
  void start();
  void stop();
  [[nodiscard]] const BotRecord& record() const { return record_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Pending {
    std::string id;
    std::string frame;
    std::string key;
    bool is_answer = false;
    bool is_continue = false;
    bool is_resent = false;
    Clock::time_point sent{};  // for the first time; before that zero
  };

  void connect();
  void on_open();
  void on_text(std::string_view text);
  void on_view(Json view);
  void on_reply(const Json& frame, bool is_accepted);
  void note_next_lesson();
  void on_lost();
  void reconnect_in(std::chrono::milliseconds time);
  void lose_connection();
  void consider();
  void act();
  void send(BotAct act);
  void transmit();
  void tick();
  void finish();
  [[nodiscard]] AnswerPath path_for(const BotAct& act);
  [[nodiscard]] std::chrono::milliseconds time_for(double pace);
  [[nodiscard]] double uniform();

  BotWorld& world_;
  std::shared_ptr<BotGroup> group_;
  std::string token_;
  std::mt19937_64 random_;
  std::string id_prefix_;
  asio::strand<asio::io_context::executor_type> strand_;
  asio::steady_timer thinking_;
  asio::steady_timer connecting_;
  asio::steady_timer ticking_;
  std::shared_ptr<ClientSocket> socket_;
  BotRecord record_;
  Json view_;
  std::optional<Pending> pending_;
  std::string done_key_;
  Clock::time_point done_at_{};
  Clock::time_point lost_at_{};
  std::string lesson_key_;
  std::uint64_t next_id_ = 0;
  int attempts_ = 0;
  int ticks_ = 0;
  bool is_welcome_ = false;  // the server has answered the hello: before that it accepts nothing else
  bool is_thinking_ = false;
  bool has_continued_ = false;
  bool is_finished_ = false;
};

}  // namespace kith
