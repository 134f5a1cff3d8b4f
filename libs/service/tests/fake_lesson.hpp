#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kith/core/live_application.hpp"

namespace kith::testing {

/// Groups that are taught for a fixed number of periods with one demonstration and one test each: what a rehearsal
/// needs of an application, without teaching and without a disk.
class FakeLesson final : public LiveApplication {
 public:
  explicit FakeLesson(int periods, bool drops_replies = false) : periods_{periods}, drops_replies_{drops_replies} {}

  ConnectionId open(std::shared_ptr<Socket> socket, std::string) override {
    const std::lock_guard lock{mutex_};
    connections_[++last_] = {std::move(socket), {}};
    return last_;
  }
  void receive(ConnectionId connection, std::string_view text) override {
    const std::lock_guard lock{mutex_};
    const auto frame = Json::parse(text);
    auto& from = connections_.at(connection);
    const auto type = frame.value("t", "");
    if (from.who.empty() && type != "hello") {
      ++early_frames;
      return from.socket->close(1008, "the first message must be a hello");
    }
    if (type == "beat") return;
    if (type == "hello") {
      from.who = frame.value("token", "");
      from.socket->authenticated();
      say(from, {{"t", "welcome"}, {"role", "participant"}});
      if (!is_staff(from.who)) people_[from.who].connection = connection;
      return show(from.who);
    }
    if (is_staff(from.who)) {
      if (type == "room-select") looked_at[from.who].insert(frame["body"].value("room", ""));
      if (type == "room-make") make_rooms(frame["body"]);
      if (type == "end") end_room(frame["body"].value("room", ""));
      say(from, {{"t", "ack"}, {"id", frame["id"]}});
      return show(from.who);
    }
    auto& person = people_.at(from.who);
    const auto id = frame.value("id", "");
    if (seen.insert(id).second) {
      if (type == "answer") {
        answers.push_back(id);
        paths.insert(frame["body"]["actions"].dump());
      }
      act(person, type);
      if (type == "answer" && drops_replies_ && answers.size() % 5 == 0) {
        show_group(person.room);
        return from.socket->close(1012, "dropped");
      }
    }
    say(from, {{"t", "ack"}, {"id", id}});
    show_group(person.room);
  }
  void closed(ConnectionId connection) override {
    const std::lock_guard lock{mutex_};
    connections_.erase(connection);
  }
  void http(HttpRequest, HttpAnswer answer) override { answer({.status = 404, .body = "{}"}); }

  [[nodiscard]] std::size_t num_rooms() {
    const std::lock_guard lock{mutex_};
    return rooms_.size();
  }

  /// Those in which somebody has not come to an end.
  [[nodiscard]] std::size_t num_unfinished_rooms() {
    const std::lock_guard lock{mutex_};
    return static_cast<std::size_t>(std::count_if(rooms_.begin(), rooms_.end(), [&](const auto& room) {
      return std::any_of(room.second.begin(), room.second.end(), [&](const auto& token) {
        return people_[token].stage != "debrief" && people_[token].stage != "ended";
      });
    }));
  }

  std::vector<std::string> answers;  ///< Ids, in order.
  std::set<std::string> paths;
  std::set<std::string> seen;
  std::map<std::string, std::set<std::string>> looked_at;  ///< Rooms, by who looked.
  int early_frames = 0;                                    ///< Before the hello of their connection.

 private:
  using Json = nlohmann::json;
  struct Connected {
    std::shared_ptr<Socket> socket;
    std::string who;
  };
  struct Person {
    std::string room;
    std::string stage = "consent";
    int period = 0;
    ConnectionId connection = 0;
  };

  static bool is_staff(const std::string& who) { return who == "facilitator" || who == "observer"; }
  static void say(const Connected& to, const Json& frame) {
    to.socket->send(std::make_shared<const std::string>(frame.dump()));
  }

  void make_rooms(const Json& body) {
    for (int i = body.value("count", 1); i > 0; --i) {
      const auto room = "r" + std::to_string(rooms_.size() + 1);
      const auto people = body.contains("seats") ? body["seats"].size() : 3;
      for (std::size_t seat = 1; seat <= people; ++seat) {
        const auto token = room + "-" + std::to_string(seat);
        rooms_[room].push_back(token);
        people_[token].room = room;
      }
    }
  }
  void end_room(const std::string& room) {
    for (const auto& token : rooms_[room]) {
      auto& stage = people_[token].stage;
      if (stage != "debrief") stage = "ended";
    }
    show_group(room);
  }
  // The next stage; who has answered waits for the others.
  void act(Person& person, const std::string& type) {
    static const std::map<std::string, std::string> kNext{{"consent", "check"},
                                                          {"checked", "watch"},
                                                          {"watched", "predict"},
                                                          {"answer", "wait"},
                                                          {"questions", "debrief"}};
    if (type == "continue") {
      person.stage = ++person.period < periods_ ? "watch" : "questions";
      return;
    }
    const auto next = kNext.find(type);
    if (next != kNext.end()) person.stage = next->second;
    const auto& group = rooms_[person.room];
    const bool all_wait = std::all_of(group.begin(), group.end(), [&](const auto& token) {
      return people_[token].stage == "wait" && people_[token].period == person.period;
    });
    if (!all_wait) return;
    for (const auto& token : group) people_[token].stage = "feedback";
  }
  void show_group(const std::string& room) {
    for (const auto& token : rooms_[room]) show(token);
  }
  void show(const std::string& who) {
    if (is_staff(who)) {
      Json rooms = Json::array();
      for (const auto& [room, tokens] : rooms_) {
        Json seats = Json::array();
        for (const auto& token : tokens) seats.push_back({{"link", "http://localhost/j#t=" + token}});
        rooms.push_back({{"id", room}, {"seats", seats}});
      }
      for (const auto& [id, connection] : connections_) {
        if (connection.who == who)
          say(connection, {{"t", "view"}, {"view", {{"rooms", rooms}, {"integrity", {{"problems", {"a page"}}}}}}});
      }
      return;
    }
    const auto& person = people_[who];
    const auto found = connections_.find(person.connection);
    if (found == connections_.end()) return;
    Json view{{"stage", person.stage}, {"progress", {{"part", 1}, {"round", person.period}}}};
    view["consent"] = {{"version", "1"}};
    view["watch"] = {{"index", 0}, {"of", 1}};
    view["predict"] = {{"index", 0}, {"of", 1}, {"world", "w"}, {"start", 0}};
    view["questions"] = {{"items", {{{"id", "q"}, {"kind", "likert"}}}}};
    say(found->second, {{"t", "view"}, {"view", view}});
  }

  int periods_;
  bool drops_replies_;
  std::mutex mutex_;
  ConnectionId last_ = 0;
  std::map<ConnectionId, Connected> connections_;
  std::map<std::string, std::vector<std::string>> rooms_;
  std::map<std::string, Person> people_;
};

}  // namespace kith::testing
