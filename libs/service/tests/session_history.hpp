#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/sha256.hpp"
#include "kith/live/live_study.hpp"
#include "kith/store/event_file.hpp"
#include "kith/store/session_export.hpp"
#include "kith/store/session_review.hpp"

namespace kith::testing {

/// What happened between clients and a server, as the clients saw it, and a checker of what must hold of it whatever
/// went wrong meanwhile (connections, processes, disks). Not synchronised.
class SessionHistory {
 public:
  /// A client sends a message, perhaps again.
  void invoke(const std::string& client, const std::string& id, const std::string& type, const Json& body) {
    invoked_[id] = {client, type, body};
  }
  /// The server acknowledged it, or refused it.
  void ok(const std::string& id) { acknowledged_.insert(id); }
  void fail(const std::string& id) { refused_.insert(id); }
  /// A client was shown a view.
  void saw(const std::string& client, const Json& view) {
    last_stage_[client] = view.value("stage", std::string{});
    if (!view.contains("watch") || !view.contains("progress")) return;
    const auto round = view["progress"].value("round", std::size_t{0});
    const auto index = view["watch"].value("index", std::size_t{0});
    demonstrations_[client][{round, index}].insert(
        sha256(view["watch"]["board"].dump() + view["watch"]["frames"].dump()));
    auto& last = last_round_[client];
    if (round < last)
      problems_.push_back(client + " was shown round " + std::to_string(round) + " after " + std::to_string(last));
    last = std::max(last, round);
  }
  /// Clients of one room.
  void group(const std::string& client, const std::string& room) { rooms_[room].push_back(client); }

  /// Everything that does not hold, in words; empty if all is well. @param must_end  whether everybody has to have
  /// reached a last page.
  [[nodiscard]] std::vector<std::string> check(EventFile& file, const std::shared_ptr<const LiveStudy>& study,
                                               bool must_end = true) {
    auto problems = problems_;
    const auto complain = [&](const std::string& what) { problems.push_back(what); };
    try {
      file.verify();  // checksums; (3) numbers without gaps
    } catch (const Error& error) {
      complain(error.what());
      return problems;
    }
    // (1) what was acknowledged is stored once, and (2) nothing is stored that nobody sent.
    std::map<std::string, StoredEvent> stored;
    std::size_t answers = 0;
    std::size_t events = 0;
    file.for_each_event([&](const StoredEvent& event) {
      ++events;
      answers += event.type == "answered" ? 1u : 0u;
      const bool is_by_client = event.actor.compare(0, 5, "seat:") == 0;
      if (is_by_client && !event.message) complain("an event of a client without a message: " + event.json);
      if (!event.message || !is_by_client) return;
      if (!stored.emplace(*event.message, event).second) complain("stored twice: " + *event.message);
      const auto found = invoked_.find(*event.message);
      if (found == invoked_.end()) {
        complain("stored, but never sent: " + *event.message);
      } else if (found->second.type == "answer" &&
                 Json::parse(event.json)["actions"] != found->second.body["actions"]) {
        complain("stored differently than sent: " + *event.message);
      }
    });
    for (const auto& id : acknowledged_) {
      const auto& message = invoked_.at(id);
      if (message.type != "answer" || stored.count(id) != 0) continue;
      // The same answer under another id may have been stored before.
      const bool is_there = std::any_of(stored.begin(), stored.end(), [&](const auto& one) {
        const auto sent = invoked_.find(one.first);
        if (sent == invoked_.end()) return false;
        const auto& other = sent->second;
        return other.client == message.client && other.type == "answer" && other.body["test"] == message.body["test"] &&
               other.body["actions"] == message.body["actions"];
      });
      if (!is_there) complain("acknowledged, but not stored: " + id);
    }
    for (const auto& id : refused_) {
      if (stored.count(id) != 0) complain("refused, but stored: " + id);
    }
    // (4), (5), (7) every room replays: the order of events is that of the state machine, lessons are the same.
    TeachingCache cache{study->atlas};
    for (const auto& room : file.rooms()) {
      const auto replayed = replay_room(file, room, study, cache);
      if (!replayed.problem.empty()) complain("room " + replayed.id + ": " + replayed.problem);
    }
    // (6) everybody in a room saw the same demonstrations in the same order.
    for (const auto& [room, clients] : rooms_) {
      std::map<std::pair<std::size_t, std::size_t>, std::set<std::string>> seen;
      for (const auto& client : clients) {
        for (const auto& [place, hashes] : demonstrations_[client]) seen[place].insert(hashes.begin(), hashes.end());
      }
      for (const auto& [place, hashes] : seen) {
        if (hashes.size() != 1)
          complain("room " + room + " saw different demonstrations in round " + std::to_string(place.first));
      }
    }
    // (8) the export is the store.
    try {
      std::map<std::string, std::size_t> lines;
      const auto report = export_session(file, study, cache, {}, [](std::string_view, std::string_view) {});
      if (report.rows.at("tests.csv") < answers) complain("the export lacks answers");
    } catch (const Error& error) {
      complain(error.what());
    }
    // (9) everybody reached a last page.
    for (const auto& [client, stage] : last_stage_) {
      const bool is_last =
          stage == "debrief" || stage == "declined" || stage == "full" || stage == "ended" || stage == "replaced";
      if (must_end && !is_last) complain(client + " is left in '" + stage + "'");
    }
    if (events == 0) complain("nothing happened");
    return problems;
  }

  [[nodiscard]] std::size_t num_acknowledged() const { return acknowledged_.size(); }

 private:
  struct Sent {
    std::string client;
    std::string type;
    Json body;
  };
  std::map<std::string, Sent> invoked_;
  std::set<std::string> acknowledged_, refused_;
  std::map<std::string, std::string> last_stage_;
  std::map<std::string, std::size_t> last_round_;
  std::map<std::string, std::map<std::pair<std::size_t, std::size_t>, std::set<std::string>>> demonstrations_;
  std::map<std::string, std::vector<std::string>> rooms_;
  std::vector<std::string> problems_;
};

}  // namespace kith::testing
