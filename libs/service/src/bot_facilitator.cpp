#include "bot_facilitator.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "kith/core/error.hpp"

namespace kith {
namespace {

constexpr std::chrono::seconds kPatience{30};
constexpr std::size_t kRoomsAtOnce = 100;
constexpr std::chrono::milliseconds kPace{50};

std::string token_of(const std::string& link) {
  const auto mark = link.find("#t=");
  return mark == std::string::npos ? std::string{} : link.substr(mark + 3);
}

bool is_simulated(const Json& seat) { return seat.value("kind", "") == "simulated"; }

}  // namespace

struct BotFacilitator::Shared {
  explicit Shared(asio::io_context& io) : strand{asio::make_strand(io)}, beating{strand} {}

  asio::strand<asio::io_context::executor_type> strand;
  asio::steady_timer beating;
  std::shared_ptr<ClientSocket> socket;
  std::mutex mutex;
  std::condition_variable changed;
  Json view;
  std::string problem;
  bool is_welcome = false;
  std::string id_prefix = random_prefix();
  std::size_t next_id = 0;
  std::size_t num_replies = 0;
  bool is_closed = false;
};

namespace {

// Named, since it starts itself again.
template <typename Shared>
void beat(const std::shared_ptr<Shared>& shared) {
  shared->beating.expires_after(std::chrono::seconds{5});
  shared->beating.async_wait([shared](NetError error) {
    if (error) return;
    shared->socket->send(R"({"t":"beat"})");
    beat(shared);
  });
}

}  // namespace

BotFacilitator::BotFacilitator(asio::io_context& io, const tcp::endpoint& server, std::string token)
    : shared_{std::make_shared<Shared>(io)} {
  const std::weak_ptr<Shared> weak = shared_;
  ClientSocket::Handlers handlers;
  handlers.on_open = [weak, token = std::move(token)] {
    const auto shared = weak.lock();
    if (shared) shared->socket->send(Json{{"t", "hello"}, {"v", 1}, {"token", token}, {"tab", "rehearsal"}}.dump());
  };
  handlers.on_text = [weak](std::string_view text) {
    const auto shared = weak.lock();
    auto frame = Json::parse(text, nullptr, false);
    if (!shared || !frame.is_object()) return;
    const auto type = frame.value("t", "");
    const std::lock_guard lock{shared->mutex};
    if (type == "welcome") shared->is_welcome = true;
    if (type == "view" && frame["view"].is_object()) shared->view.update(frame["view"]);
    if (type == "ack" || type == "nak") ++shared->num_replies;
    if (type == "nak") shared->problem = frame.value("text", "refused");
    if (type == "bye") shared->problem = "the server said goodbye: " + frame.value("reason", "");
    shared->changed.notify_all();
  };
  handlers.on_closed = [weak] {
    const auto shared = weak.lock();
    if (!shared) return;
    const std::lock_guard lock{shared->mutex};
    shared->is_closed = true;
    if (shared->problem.empty()) shared->problem = "the connection was closed";
    shared->changed.notify_all();
  };
  shared_->socket = std::make_shared<ClientSocket>(shared_->strand, std::move(handlers));
  asio::post(shared_->strand, [shared = shared_, server] {
    shared->socket->connect(server);
    beat(shared);
  });
}

BotFacilitator::~BotFacilitator() {
  try {
    asio::post(shared_->strand, [shared = shared_] {
      shared->beating.cancel();
      shared->socket->cut();
    });
  } catch (const std::exception&) {  // out of memory: the connection ends with its io_context
  }
}

bool BotFacilitator::wait(std::chrono::milliseconds time, const std::function<bool()>& holds) {
  std::unique_lock lock{shared_->mutex};
  shared_->changed.wait_for(lock, time, [&] { return holds() || !shared_->problem.empty(); });
  return holds();
}

void BotFacilitator::say(const std::string& type, Json body) {
  body["reason"] = "rehearsal";
  asio::post(shared_->strand, [shared = shared_, type, body = std::move(body)] {
    const auto id = shared->id_prefix + std::to_string(shared->next_id++);
    shared->socket->send(Json{{"t", type}, {"id", id}, {"body", body}}.dump());
  });
}

std::vector<BotFacilitator::Room> BotFacilitator::make_rooms(std::size_t count, std::set<std::string> earlier) {
  const auto fail = [&] {
    const std::lock_guard lock{shared_->mutex};
    throw Error{ErrorKind::kIo, "the rehearsal cannot make its rooms: " +
                                    (shared_->problem.empty() ? "the server does not answer" : shared_->problem)};
  };
  auto& view = shared_->view;
  const auto has_rooms = [&view] { return view.is_object() && view.contains("rooms"); };
  if (!wait(kPatience, has_rooms)) fail();
  {
    const std::lock_guard lock{shared_->mutex};
    for (const auto& room : view["rooms"]) earlier.insert(room.value("id", ""));
  }
  // Rooms of before a restart have no links that the server knows.
  const auto is_made = [&](const Json& room) {
    if (earlier.count(room.value("id", "")) > 0) return false;
    const auto& seats = room.at("seats");
    return !seats.empty() && std::all_of(seats.begin(), seats.end(),
                                         [](const Json& seat) { return is_simulated(seat) || seat.contains("link"); });
  };
  for (std::size_t made = 0; made < count;) {
    const auto now = std::min(kRoomsAtOnce, count - made);
    say("room-make", {{"count", now}});
    made += now;
    const auto has_all = [&] {
      const auto& rooms = view["rooms"];
      return static_cast<std::size_t>(std::count_if(rooms.begin(), rooms.end(), is_made)) >= made;
    };
    if (!wait(kPatience, has_all)) fail();
  }
  std::vector<Room> rooms;
  const std::lock_guard lock{shared_->mutex};
  for (const auto& room : view["rooms"]) {
    if (!is_made(room)) continue;
    Room one{.id = room.value("id", ""), .tokens = {}};
    for (const auto& seat : room["seats"]) {
      if (!is_simulated(seat)) one.tokens.push_back(token_of(seat.value("link", "")));
    }
    rooms.push_back(std::move(one));
  }
  return rooms;
}

void BotFacilitator::look_at(const std::string& room) {
  if (wait(std::chrono::milliseconds{0}, [this] { return shared_->is_welcome; })) say("room-select", {{"room", room}});
}

bool BotFacilitator::is_closed() const {
  const std::lock_guard lock{shared_->mutex};
  return shared_->is_closed;
}

std::vector<std::string> BotFacilitator::problems() const {
  const std::lock_guard lock{shared_->mutex};
  if (!shared_->view.is_object() || !shared_->view.contains("integrity")) return {};
  return shared_->view["integrity"].value("problems", std::vector<std::string>{});
}

void BotFacilitator::end_rooms(const std::vector<Room>& rooms) {
  if (!wait(kPatience, [this] { return shared_->is_welcome; })) return;
  for (const auto& room : rooms) {
    say("end", {{"room", room.id}});
    std::this_thread::sleep_for(kPace);
  }
  // A room that has ended already refuses, which is a reply too.
  std::unique_lock lock{shared_->mutex};
  shared_->changed.wait_for(lock, kPatience,
                            [&] { return shared_->is_closed || shared_->num_replies >= rooms.size(); });
}

}  // namespace kith
