#include "local_facilitator.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "kith/core/error.hpp"

namespace kith::cli {
namespace {

constexpr std::chrono::seconds kPatience{20};
constexpr std::size_t kRoomsAtOnce = 100;

}  // namespace

struct LocalFacilitator::Ear final : LiveService::Socket {
  void send(std::shared_ptr<const std::string> frame) override {
    auto json = Json::parse(*frame, nullptr, false);
    if (!json.is_object()) return;
    const auto type = json.value("t", "");
    const std::lock_guard lock{mutex};
    if (type == "view") {
      view = std::move(json["view"]);
    } else if (type == "ack" || type == "nak") {
      replies[json.value("id", "")] = type == "ack" ? std::string{} : json.value("text", "refused");
    }
    changed.notify_all();
  }
  void close(std::uint16_t, std::string) override {}

  std::mutex mutex;
  std::condition_variable changed;
  Json view;
  std::map<std::string, std::string> replies;  // by id; empty: accepted
};

LocalFacilitator::LocalFacilitator(LiveService& service, const std::string& token)
    : service_{service}, ear_{std::make_shared<Ear>()}, connection_{service.open(ear_)} {
  service_.receive(connection_, Json{{"t", "hello"}, {"v", 1}, {"token", token}, {"tab", "local"}}.dump());
}

LocalFacilitator::~LocalFacilitator() { service_.closed(connection_); }

Json LocalFacilitator::view(const std::function<bool(const Json&)>& wanted) {
  std::unique_lock lock{ear_->mutex};
  const auto is_there = [&] { return ear_->view.is_object() && (!wanted || wanted(ear_->view)); };
  if (!ear_->changed.wait_for(lock, kPatience, is_there)) {
    throw Error{ErrorKind::kIo, "the session does not answer; is the disk very slow?"};
  }
  return ear_->view;
}

void LocalFacilitator::ask(const std::string& type, Json body) {
  body["reason"] = "kith serve";
  // Ids are remembered for good, also those of an earlier start.
  const auto start = std::chrono::system_clock::now().time_since_epoch().count();
  const auto id = "local-" + std::to_string(start) + "-" + std::to_string(next_id_++);
  service_.receive(connection_, Json{{"t", type}, {"id", id}, {"body", std::move(body)}}.dump());
  std::unique_lock lock{ear_->mutex};
  if (!ear_->changed.wait_for(lock, kPatience, [&] { return ear_->replies.count(id) > 0; })) {
    throw Error{ErrorKind::kIo, "the session does not answer; is the disk very slow?"};
  }
  const auto& refusal = ear_->replies.at(id);
  if (!refusal.empty()) throw Error{ErrorKind::kInfeasible, refusal};
}

void LocalFacilitator::make_rooms(std::size_t count, const std::vector<std::string>& seats) {
  for (auto there = service_.num_rooms(); there < count; there = service_.num_rooms()) {
    Json body{{"count", std::min(kRoomsAtOnce, count - there)}};
    if (!seats.empty()) body["seats"] = seats;
    ask("room-make", std::move(body));
  }
}

}  // namespace kith::cli
