#include "connection.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace kith {

void Connection::answer(const std::string& message, const std::optional<Refusal>& refusal) const {
  if (!refusal) return send({{"t", "ack"}, {"id", message}});
  send({{"t", "nak"}, {"id", message}, {"reason", refusal->reason}, {"text", refusal->text}});
}

void Connection::show(Json view) {
  if (is_closed) return;
  const auto now = view.at("server_ms").dump();
  view.erase("server_ms");
  auto text = view.dump();
  if (text == last_view) return;
  last_view = std::move(text);
  socket->send(std::make_shared<const std::string>(
      R"({"t":"view","view":)" + last_view.substr(0, last_view.size() - 1) + R"(,"server_ms":)" + now + "}}"));
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
