// Whoever loses the connection before the acknowledgement sends again: nothing happens twice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "kith/service/authorisation.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using testing::Group;
using testing::Page;
using testing::play_until;

// All that has happened but for who was there when, and how many links there are.
std::vector<std::string> history_of(const testing::Stage& stage) {
  std::vector<std::string> history;
  auto file = testing::stored(stage);
  file.for_each_event([&](const StoredEvent& event) {
    if (event.type == "present" || event.type == "away") return;
    auto body = Json::parse(event.json);
    for (const auto* secret : {"code", "token", "key", "digest"}) body.erase(secret);
    history.push_back(std::to_string(event.room) + " " + event.actor + " " + event.type + " " + body.dump());
  });
  history.push_back(std::to_string(file.rooms().size()) + " rooms, " + std::to_string(file.tokens().size()) + " links");
  return history;
}

// How a message of one kind comes to be sent.
struct Kind {
  std::string type;
  std::function<bool(Group& group)> reach;                 // brings the group to where it is possible
  std::function<Json(Group& group, Page& sender)> body{};  // none: an empty one
};

// The sender's page; the message is sent, the connection is lost before anything is read, and the page sends it again.
enum class Loss { kNone, kTwiceAtOnce, kConnection, kServer };

const char* name_of(Loss loss) {
  constexpr const char* kNames[] = {"sent once", "sent twice", "the connection was lost", "the server was restarted"};
  return kNames[static_cast<std::size_t>(loss)];
}

std::vector<std::string> history_after(const Kind& kind, bool is_facilitator, Loss loss) {
  Group group{std::string{testing::kQuestions} +
              "ask_name = true\nscreening = { tests = 1 }\ntime = { predict_s = 600, leave_after_s = 0 }\n"
              "dropout = { policy = \"continue-now\" }\n" +
              (kind.type == std::string{"examine"} ? "exam = true\n" : "")};
  auto& [scratch, stage, solver, people] = group;
  EXPECT_TRUE(kind.reach(group)) << kind.type;
  const auto facilitator = is_facilitator ? stage.facilitator() : nullptr;
  auto& sender = is_facilitator ? *facilitator : *people[0];
  if (is_facilitator) stage.show(sender);
  auto body = kind.body ? kind.body(group, sender) : Json::object();
  if (is_facilitator) body["reason"] = "a test";
  const auto id = sender.ask(stage.service(), kind.type, body);
  if (loss == Loss::kTwiceAtOnce) sender.send(stage.service(), sender.unsaved().front());
  stage.service().settle();
  if (loss == Loss::kConnection) {
    sender.disconnect(stage.service());
    sender.connect(stage.service());
  } else if (loss == Loss::kServer) {
    stage.restart();
    sender.lose();
    sender.connect(stage.service());
  }
  for (int i = 0; i < 3; ++i) stage.service().settle();
  sender.read();
  // Whoever has left for good cannot say anything any more; all others are told that it was accepted.
  EXPECT_THAT(sender.acks(), Contains(id)) << kind.type << ", " << name_of(loss) << ": " << sender.last_nak();
  EXPECT_TRUE(sender.naks().empty()) << kind.type << ", " << name_of(loss) << ": " << sender.last_nak();
  EXPECT_TRUE(sender.unsaved().empty()) << kind.type << ", " << name_of(loss);
  return history_of(stage);
}

void expect_once(const Kind& kind, bool is_facilitator) {
  const auto once = history_after(kind, is_facilitator, Loss::kNone);
  for (const auto loss : {Loss::kTwiceAtOnce, Loss::kConnection, Loss::kServer}) {
    auto now = history_after(kind, is_facilitator, loss);
    // A new start makes new links for facilitators and observers.
    if (loss == Loss::kServer) now.back() = once.back();
    EXPECT_EQ(now, once) << kind.type << ", " << name_of(loss);
  }
}

std::function<bool(Group& group)> until(const std::string& stage) {
  return [stage](Group& group) { return play_until(group.stage, group.people, group.solver, stage); };
}
bool at_once(Group&) { return true; }

// What a person's page would send next.
Json next_body(Group& group, Page& sender) {
  return testing::next_step(sender.view(), group.solver, true).value().second;
}

const std::vector<Kind>& kinds_of_participants() {
  static const std::vector<Kind> kKinds{
      {"consent", at_once, next_body},
      {"checked", until("check")},
      {"name", until("check"),
       [](Group&, Page&) {
         return Json{{"name", "Ada"}};
       }},
      {"screen", until("screening"), next_body},
      {"watched", until("watch"), next_body},
      {"draft", until("predict"),
       [](Group& group, Page& sender) {
         auto body = next_body(group, sender);
         return Json{{"test", body["test"]}, {"actions", Json::array({body["actions"][0]})}};
       }},
      {"answer", until("predict"), next_body},
      {"continue", until("feedback")},
      {"examine", until("exam"), next_body},
      {"questions", until("questions"), next_body},
      {"leave", until("watch")},
  };
  return kKinds;
}

const std::vector<Kind>& kinds_of_facilitators() {
  const auto in_room = [](Json more = Json::object()) {
    return [more](Group&, Page&) {
      auto body = more;
      body["room"] = "r1";
      return body;
    };
  };
  // Two people are ready and one is not.
  const auto almost_ready = [](Group& group) {
    std::vector<std::unique_ptr<Page>> two;
    for (std::size_t i = 0; i < 2; ++i) two.push_back(std::move(group.people[i]));
    const bool is_there = play_until(group.stage, two, group.solver, "lobby");
    for (std::size_t i = 0; i < 2; ++i) group.people[i] = std::move(two[i]);
    return is_there;
  };
  const auto one_has_left = [](Group& group) {
    if (!play_until(group.stage, group.people, group.solver, "watch")) return false;
    group.people[2]->ask(group.stage.service(), "leave", Json::object());
    group.stage.service().settle();
    return true;
  };
  static const std::vector<Kind> kKinds{
      {"start", almost_ready, in_room()},
      {"pause", until("watch"), in_room()},
      {"resume",
       [](Group& group) {
         if (!play_until(group.stage, group.people, group.solver, "watch")) return false;
         const auto page = group.stage.facilitator();
         page->ask(group.stage.service(), "pause", {{"room", "r1"}, {"reason", "a break"}});
         group.stage.service().settle();
         return true;
       },
       in_room()},
      {"extend", until("predict"), in_room({{"seconds", 60}})},
      {"message", until("watch"), in_room({{"text", "Hello"}})},
      {"readmit", one_has_left, in_room({{"seat", 3}})},
      {"simulate", until("watch"), in_room({{"seat", 2}, {"type", "N"}})},
      {"strategy", until("watch"), in_room({{"name", "common"}})},
      {"end", until("watch"), in_room()},
      {"room-make", at_once,
       [](Group&, Page&) {
         return Json{{"seats", {"person", "N", "P"}}, {"count", 2}};
       }},
      {"room-select", at_once, in_room()},
      {"link-revoke", at_once,
       [](Group& group, Page&) {
         return Json{{"token", group.people[1]->token()}};
       }},
  };
  return kKinds;
}

// Every kind of message that there is, so that a new one is not forgotten. This study has neither discussions nor
// worlds to explore; the tests of rooms send those.
TEST(Resending, HasAllKindsOfMessages) {
  for (const bool is_facilitator : {false, true}) {
    std::set<std::string> listed, allowed;
    for (const auto& kind : is_facilitator ? kinds_of_facilitators() : kinds_of_participants())
      listed.insert(kind.type);
    for (const auto& permission : permissions()) {
      const std::string name{permission.name};
      if (name == "hello" || name == "beat" || name.find(' ') != std::string::npos) continue;
      if (name == "discuss" || name == "explore") continue;
      if (is_facilitator ? permission.facilitator : permission.participant) allowed.insert(name);
    }
    EXPECT_EQ(listed, allowed);
  }
}

TEST(Resending, DoesNothingTwiceForParticipants) {
  for (const auto& kind : kinds_of_participants()) expect_once(kind, false);
}

TEST(Resending, DoesNothingTwiceForFacilitators) {
  for (const auto& kind : kinds_of_facilitators()) expect_once(kind, true);
}

// A whole series is sent again, in its order. What changed nothing the first time must not do so now.
TEST(Resending, DoesNothingTwiceInASeries) {
  const std::vector<std::vector<std::string>> series{{"pause", "pause", "resume"},
                                                     {"resume", "pause"},
                                                     {"pause", "resume", "resume", "pause", "pause"},
                                                     {"message", "pause", "message", "resume"}};
  for (const auto& types : series) {
    std::vector<std::vector<std::string>> histories;
    for (const bool is_lost : {false, true}) {
      Group group{"dropout = { policy = \"continue-now\" }\n"};
      ASSERT_TRUE(play_until(group.stage, group.people, group.solver, "watch"));
      const auto facilitator = group.stage.facilitator();
      for (const auto& type : types) {
        facilitator->ask(group.stage.service(), type, {{"room", "r1"}, {"text", "Hello"}, {"reason", "a test"}});
        group.stage.service().settle();
      }
      if (is_lost) {
        facilitator->disconnect(group.stage.service());
        facilitator->connect(group.stage.service());
        group.stage.service().settle();
      }
      facilitator->read();
      EXPECT_EQ(facilitator->acks().size(), types.size()) << ::testing::PrintToString(types);
      histories.push_back(history_of(group.stage));
    }
    EXPECT_EQ(histories[0], histories[1]) << ::testing::PrintToString(types);
  }
}

}  // namespace
}  // namespace kith
