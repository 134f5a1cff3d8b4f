#include "kith/service/server.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <exception>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "kith/core/error.hpp"
#include "listener.hpp"
#include "net.hpp"
#include "server_context.hpp"
#include "threads.hpp"

namespace kith {

struct Server::State {
  State(ServerOptions options, LiveApplication& application) : context{std::move(options), application} {}

  // Handlers do not throw; if one does, that is a bug which must not end the other connections.
  void run_handlers() {
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::exception& error) {
        context.notice(ServerNotice::Kind::kFailure, "internal error: " + std::string{error.what()});
      }
    }
  }

  ServerContext context;
  asio::io_context io;  // after the context: handlers that are dropped with it refer to that
  std::optional<asio::executor_work_guard<asio::io_context::executor_type>> work;
  std::shared_ptr<Listener> listener;
  std::vector<std::jthread> threads;
  bool is_stopped = false;
};

Server::Server(ServerOptions options, LiveApplication& application)
    : state_{std::make_unique<State>(std::move(options), application)} {
  auto& state = *state_;
  state.listener = std::make_shared<Listener>(state.context, state.io);
  state.work.emplace(state.io.get_executor());
  const auto wanted = state.context.options.io_threads;
  state.threads = start_threads(wanted, [&state] { state.run_handlers(); });
  if (state.threads.empty()) {
    throw Error{ErrorKind::kIo, "the system grants no thread to serve with",
                Advice{"raise the limit on processes (ulimit -u)"}};
  }
  if (state.threads.size() < wanted) {
    state.context.notice(ServerNotice::Kind::kThreads,
                         "the system grants fewer threads than wanted; serving is slower");
  }
  state.listener->start();
}

Server::~Server() { stop(std::chrono::milliseconds{0}); }

std::uint16_t Server::port() const { return state_->listener->port(); }

ServerStatus Server::status() const {
  const auto& context = state_->context;
  return {.connections = context.admission.num_sockets(),
          .web_sockets = context.web_sockets,
          .requests = context.requests,
          .frames_in = context.frames_in,
          .turned_away = context.admission.num_turned_away(),
          .slow_clients = context.slow_clients,
          .timed_out = context.timed_out};
}

void Server::stop(std::chrono::milliseconds patience) {
  auto& state = *state_;
  if (std::exchange(state.is_stopped, true)) return;
  state.listener->stop();
  state.context.connections.stop_all();
  if (!state.context.connections.wait_until_none(std::chrono::steady_clock::now() + patience)) {
    state.context.connections.cut_all();
    state.context.connections.wait_until_none(std::chrono::steady_clock::now() + std::chrono::seconds{10});
  }
  state.work.reset();
  state.io.stop();
  state.threads.clear();
}

}  // namespace kith
