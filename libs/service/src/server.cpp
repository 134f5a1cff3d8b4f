#include "kith/service/server.hpp"

#include <exception>
#include <utility>

#include "listener.hpp"
#include "server_context.hpp"
#include "threads.hpp"

namespace kith {

struct Server::State {
  // Handlers do not throw; if one does, that is a bug which must not end the other connections.
  State(ServerOptions options, LiveApplication& application)
      : context{std::move(options), application},
        threads{context.options.io_threads, [this](const std::exception& error) {
                  context.notice(ServerNotice::Kind::kFailure, "internal error: " + std::string{error.what()});
                }} {}

  ServerContext context;
  Threads threads;  // after the context: handlers that are dropped with them refer to that
  std::shared_ptr<Listener> listener;
  bool is_stopped = false;
};

Server::Server(ServerOptions options, LiveApplication& application)
    : state_{std::make_unique<State>(std::move(options), application)} {
  auto& state = *state_;
  if (state.threads.size() < state.context.options.io_threads) {
    state.context.notice(ServerNotice::Kind::kThreads,
                         "the system grants fewer threads than wanted; serving is slower");
  }
  state.listener = std::make_shared<Listener>(state.context, state.threads.io());
  state.listener->start();
}

Server::~Server() { stop(std::chrono::milliseconds{0}); }

std::uint16_t Server::port() const { return state_->listener->port(); }

ServerStatus Server::status() const {
  const auto& context = state_->context;
  return {.connections = context.admission.num_sockets(),
          .web_sockets = context.web_sockets,
          .requests = context.requests,
          .turned_away = context.admission.num_turned_away(),
          .slow_clients = context.slow_clients};
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
  state.threads.stop();
}

}  // namespace kith
