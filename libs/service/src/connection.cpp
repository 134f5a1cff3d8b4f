#include "connection.hpp"

#include <utility>

namespace kith {

void Connection::answer(const std::string& message, const std::optional<Refusal>& refusal) const {
  if (!refusal) return send({{"t", "ack"}, {"id", message}});
  send({{"t", "nak"}, {"id", message}, {"reason", refusal->reason}, {"text", refusal->text}});
}

void Connection::show(Json view) {
  if (is_closed) return;
  const auto time = view.find("server_ms");
  const Json now = time == view.end() ? Json{} : *time;
  if (time != view.end()) *time = 0;
  auto text = view.dump();
  if (text == last_view) return;
  last_view = std::move(text);
  if (time != view.end()) *time = now;
  send({{"t", "view"}, {"view", std::move(view)}});
}

void Connection::dismiss(const char* reason, std::uint16_t code) {
  if (is_closed.exchange(true)) return;
  send({{"t", "bye"}, {"reason", reason}});
  socket->close(code, reason);
}

void Connection::hang_up(std::uint16_t code, const char* reason) {
  if (!is_closed.exchange(true)) socket->close(code, reason);
}

}  // namespace kith
