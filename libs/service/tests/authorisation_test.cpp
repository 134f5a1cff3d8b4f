#include "kith/service/authorisation.hpp"

#include <gtest/gtest.h>

#include <array>

#include "service_support.hpp"

namespace kith {
namespace {

using testing::FakeSocket;
using testing::Page;
using testing::ScratchFolder;
using testing::small_study;
using testing::Stage;

// Who may ask for what, written down once more: a change of the table in the sources has to be made here, too.
// Columns: nobody, participant, observer, facilitator.
struct Expected {
  const char* name;
  const char* allowed;
};
constexpr Expected kMessages[] = {
    {"beat", "-pof"},        {"consent", "-p--"},     {"checked", "-p--"},  {"name", "-p--"},
    {"screen", "-p--"},      {"watched", "-p--"},     {"draft", "-p--"},    {"answer", "-p--"},
    {"discuss", "-p--"},     {"explore", "-p--"},     {"continue", "-p--"}, {"questions", "-p--"},
    {"examine", "-p--"},     {"leave", "-p--"},       {"start", "---f"},    {"pause", "---f"},
    {"resume", "---f"},      {"extend", "---f"},      {"message", "---f"},  {"readmit", "---f"},
    {"simulate", "---f"},    {"strategy", "---f"},    {"end", "---f"},      {"room-make", "---f"},
    {"room-select", "--of"}, {"link-revoke", "---f"}, {"join", "----"},     {"away", "----"},
    {"present", "----"},     {"lesson", "----"},      {"", "----"}};
constexpr Expected kRoutes[] = {
    {"GET /api/health", "npof"},    {"POST /api/join", "npof"},        {"GET /api/texts", "npof"},
    {"GET /api/world", "-pof"},     {"GET /api/export", "---f"},       {"GET /api/qr", "---f"},
    {"GET /api/integrity", "---f"}, {"POST /api/export", "----"},      {"GET /api/join", "----"},
    {"DELETE /api/health", "----"}, {"GET /api/../api/export", "----"}};
constexpr std::array kRoles{Role::kNobody, Role::kParticipant, Role::kObserver, Role::kFacilitator};

TEST(Authorisation, IsTheTableAndNothingElse) {
  std::size_t known = 1;  // hello
  EXPECT_TRUE(is_allowed("hello", Role::kNobody));
  const auto check = [&](const Expected& expected) {
    bool is_any = false;
    for (std::size_t i = 0; i < kRoles.size(); ++i) {
      const bool is_expected = expected.allowed[i] != '-';
      is_any = is_any || is_expected;
      EXPECT_EQ(is_allowed(expected.name, kRoles[i]), is_expected) << expected.name << " by " << name_of(kRoles[i]);
    }
    known += is_any ? 1u : 0u;
  };
  for (const auto& expected : kMessages) check(expected);
  for (const auto& expected : kRoutes) check(expected);
  EXPECT_EQ(known, permissions().size()) << "a message or route without an entry in this test";
}

TEST(Authorisation, NamesRolesBackAndForth) {
  for (const auto role : kRoles) EXPECT_EQ(role_named(name_of(role)), role);
  EXPECT_EQ(role_named("admin"), Role::kNobody);
}

// Tokens of every role in every state, against every message and route of a running service.
class AuthorisationMatrix : public ::testing::Test {
 protected:
  struct Link {
    std::string story;
    std::string token;
    Role role;  // that it gives
  };

  void SetUp() override {
    facilitator_ = stage_.facilitator();
    facilitator_->ask(stage_.service(), "room-make", {{"count", 1}});
    stage_.show(*facilitator_);
    stage_.show(*facilitator_);
  }

  std::string seat_link(std::size_t seat) {
    const auto link = facilitator_->view()["rooms"][0]["seats"][seat - 1]["link"].get<std::string>();
    return link.substr(link.find("#t=") + 3);
  }

  // Links that are valid now, and links that are not, for whatever reason.
  std::vector<Link> links() {
    const auto start = stage_.service().start_links();
    std::vector<Link> all{{"participant", seat_link(1), Role::kParticipant},
                          {"observer", start.observer, Role::kObserver},
                          {"facilitator", start.facilitator, Role::kFacilitator}};
    // Revoked.
    const auto revoked = stage_.service().start_links();
    for (const auto& token : {seat_link(2), revoked.observer, revoked.facilitator}) {
      facilitator_->ask(stage_.service(), "link-revoke", {{"token", token}});
      all.push_back({"revoked", token, Role::kNobody});
    }
    stage_.service().settle();
    // Forged: changed in one character, cut, extended, empty, somebody's hash.
    auto forged = start.facilitator;
    forged[5] = forged[5] == 'A' ? 'B' : 'A';
    all.push_back({"forged", forged, Role::kNobody});
    all.push_back({"cut", start.facilitator.substr(0, 21), Role::kNobody});
    all.push_back({"extended", start.facilitator + "A", Role::kNobody});
    all.push_back({"empty", "", Role::kNobody});
    // Of another server.
    Stage other{scratch_ / "other", small_study()};
    all.push_back({"of another session", other.facilitator_token(), Role::kNobody});
    return all;
  }

  void check_messages(const Link& link) {
    const auto socket = std::make_shared<FakeSocket>();
    const auto connection = stage_.service().open(socket);
    stage_.service().receive(connection, Json{{"t", "hello"}, {"v", 1}, {"token", link.token}}.dump());
    stage_.service().settle();
    if (link.role == Role::kNobody) {
      EXPECT_EQ(socket->close_code(), 1008) << link.story;
      (void)socket->take();
      for (const auto& message : kMessages) {
        stage_.service().receive(connection, Json{{"t", message.name}, {"id", "x"}, {"body", Json::object()}}.dump());
        stage_.service().settle();
        EXPECT_TRUE(socket->take().empty()) << link.story << ": " << message.name;
      }
      return;
    }
    (void)socket->take();
    for (const auto& message : kMessages) {
      const bool is_expected = message.allowed[static_cast<std::size_t>(link.role)] != '-';
      const auto id = std::string{"m-"} + message.name + std::to_string(++number_);
      // Bodies make no sense on purpose: what is allowed is refused for that, and nothing happens.
      stage_.service().receive(
          connection,
          Json{{"t", message.name}, {"id", id}, {"body", {{"token", "?"}, {"count", 0}, {"room", "?"}}}}.dump());
      stage_.service().settle();
      for (const auto& frame : socket->take()) {
        if (frame["t"] != "nak") continue;
        EXPECT_EQ(frame["reason"] != "not-allowed", is_expected) << link.story << ": " << message.name << " " << frame;
      }
    }
    stage_.service().closed(connection);
  }

  void check_routes(const Link& link) {
    for (const auto& route : kRoutes) {
      const std::string name{route.name};
      auto target = name.substr(name.find(' ') + 1);
      if (target == "/api/world") target += "/" + world_key(*stage_.study().study, MdpIndex{0});
      if (target == "/api/qr") target += "?text=x";
      const auto reply = stage_.ask({.method = name.substr(0, name.find(' ')),
                                     .target = target,
                                     .bearer = link.token,
                                     .body = "{\"code\":\"NOSUCH\"}",
                                     .remote = "test"});
      const bool is_expected = route.allowed[static_cast<std::size_t>(link.role)] != '-';
      const bool was_allowed =
          reply.status == 200 || (target == "/api/join" && reply.status == 404 && name.substr(0, 4) == "POST");
      EXPECT_EQ(was_allowed, is_expected) << link.story << ": " << name << " " << reply.status;
    }
  }

  ScratchFolder scratch_;
  Stage stage_{scratch_ / "live", small_study()};
  std::unique_ptr<Page> facilitator_;
  std::size_t number_ = 0;
};

TEST_F(AuthorisationMatrix, HoldsForEveryMessageRouteAndState) {
  const auto all = links();
  for (const auto& link : all) {
    check_messages(link);
    check_routes(link);
  }
  // Two weeks later all of them have expired.
  stage_.clock().advance_ms(std::int64_t{15} * 24 * 3600 * 1000);
  for (auto link : all) {
    link.story += ", expired";
    link.role = Role::kNobody;
    check_messages(link);
    check_routes(link);
  }
}

}  // namespace
}  // namespace kith
