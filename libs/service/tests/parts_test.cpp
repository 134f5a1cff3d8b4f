// The parts that know no sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/beast/zlib/inflate_stream.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "admission.hpp"
#include "busy_count.hpp"
#include "gzip.hpp"
#include "json_depth.hpp"
#include "request_reader.hpp"
#include "send_queue.hpp"
#include "site.hpp"
#include "token_bucket.hpp"

namespace kith {
namespace {

TEST(BusyCount, LetsGoOfWhatAJobHoldsBeforeItIsDone) {
  BusyCount busy;
  const auto held = std::make_shared<bool>(false);
  auto counted = busy.during(std::function<void(bool)>{[held](bool saved) { *held = saved; }});
  EXPECT_EQ(held.use_count(), 2);
  counted(true);
  busy.wait_for_none();
  EXPECT_TRUE(*held);
  EXPECT_EQ(held.use_count(), 1) << "although what was called is still there";
}

TEST(JsonDepth, CountsBracketsOutsideOfStrings) {
  EXPECT_FALSE(json_nests_within(std::string_view{"[1\0", 3}, 1));
  EXPECT_FALSE(json_nests_within("[]", 0));
  EXPECT_TRUE(json_nests_within(R"({"a":[1,2],"b":[]})", 2));
  EXPECT_FALSE(json_nests_within(R"({"a":[[1]]})", 2));
  EXPECT_TRUE(json_nests_within(R"(["[[[\"[[["])", 1));
  EXPECT_TRUE(json_nests_within("]]]][", 1));
  EXPECT_TRUE(json_nests_within("\"\\", 0));
}

// Inflated again by Beast; the sum and the length are at the end.
TEST(Gzip, ReadsAsWritten) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += std::to_string(i * i % 977);
  for (const std::string& one : {std::string{}, std::string{"a"}, text}) {
    const auto file = gzipped(one);
    ASSERT_GE(file.size(), 18U);
    boost::beast::zlib::inflate_stream stream;
    std::string inflated(one.size() + 1, '?');
    boost::beast::zlib::z_params state;
    state.next_in = file.data() + 10;
    state.avail_in = file.size() - 18;
    state.next_out = inflated.data();
    state.avail_out = inflated.size();
    boost::system::error_code error;
    stream.write(state, boost::beast::zlib::Flush::finish, error);
    inflated.resize(state.total_out);
    EXPECT_EQ(inflated, one);
  }
  // echo -n a | gzip -n | tail -c 8
  EXPECT_EQ(gzipped("a").substr(gzipped("a").size() - 8), std::string("\x43\xBE\xB7\xE8\x01\0\0\0", 8));
}

TEST(TokenBucket, LetsABurstAndThenARatePass) {
  using std::chrono::milliseconds;
  const std::chrono::steady_clock::time_point start{};
  TokenBucket bucket{10.0, 3.0, start};
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.take(start));
  EXPECT_FALSE(bucket.take(start));
  EXPECT_FALSE(bucket.take(start + milliseconds{90}));
  EXPECT_TRUE(bucket.take(start + milliseconds{110}));
  EXPECT_FALSE(bucket.take(start + milliseconds{110}));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.take(start + milliseconds{10'000}));
  EXPECT_FALSE(bucket.take(start + milliseconds{10'000}));
}

TEST(SendQueue, HoldsSoManyFramesAndBytes) {
  const auto frame = [](std::size_t size) { return std::make_shared<const std::string>(std::string(size, 'x')); };
  SendQueue few{2, 1000};
  EXPECT_TRUE(few.push(frame(1)));
  EXPECT_TRUE(few.push(frame(1)));
  EXPECT_FALSE(few.push(frame(1)));
  EXPECT_EQ(few.pop(), nullptr);
  EXPECT_FALSE(few.push(frame(1)));
  SendQueue small{100, 10};
  EXPECT_TRUE(small.push(frame(1000)));  // alone
  EXPECT_EQ(small.pop()->size(), 1000U);
  EXPECT_TRUE(small.push(frame(6)));
  EXPECT_TRUE(small.push(frame(4)));
  EXPECT_EQ(small.pop()->size(), 6U);
  EXPECT_TRUE(small.push(frame(6)));
  EXPECT_FALSE(small.push(frame(1)));
}

// Sockets with names that come, and how often each was cut.
class Gate {
 public:
  Gate(std::size_t max_sockets, std::size_t max_per_address) : admission{max_sockets, max_per_address} {}

  struct Guest final : ServerConnection {
    void stop() override {}
    void cut() override { ++cuts; }
    int cuts = 0;
    Admission::Place place;
  };
  // @return who has to give way; "-": the newcomer itself.
  std::string come(const std::string& name, const std::string& address, bool counts = true) {
    auto guest = std::make_shared<Guest>();
    const auto verdict = admission.enter(address, counts, guest->place);
    if (!verdict.is_welcome) return "-";
    guest->place.belongs_to(guest);
    guests[name] = guest;
    for (const auto& [other, one] : guests) {
      if (one && one == verdict.gives_way) return other;
    }
    return "";
  }

  Admission admission;
  std::map<std::string, std::shared_ptr<Guest>> guests;
};

TEST(Admission, LetsWhoeverIsIdleForLongestGiveWay) {
  Gate gate{100, 3};
  for (const auto* name : {"a", "b", "c"}) EXPECT_EQ(gate.come(name, "x"), "");
  gate.guests["a"]->place.renew();
  EXPECT_EQ(gate.come("d", "x"), "b");
  EXPECT_EQ(gate.come("e", "x"), "c");
  EXPECT_EQ(gate.come("f", "x"), "a");
  EXPECT_EQ(gate.come("g", "y"), "") << "another address";
  EXPECT_EQ(gate.come("h", "x", false), "") << "of a proxy";
  EXPECT_EQ(gate.admission.num_sockets(), 5U);
  EXPECT_EQ(gate.admission.num_turned_away(), 3U);
  gate.guests.clear();
  EXPECT_EQ(gate.admission.num_sockets(), 0U);
}

TEST(Admission, NeverLetsGiveWayWhoHasShownAToken) {
  Gate gate{4, 2};
  for (const auto* name : {"a", "b"}) {
    EXPECT_EQ(gate.come(name, "x"), "");
    gate.guests[name]->place.trust();
  }
  EXPECT_EQ(gate.come("c", "x"), "") << "the others do not count";
  EXPECT_EQ(gate.come("d", "x"), "");
  EXPECT_TRUE(gate.admission.is_crowded());
  EXPECT_EQ(gate.come("e", "y"), "c") << "all places are taken";
  gate.guests["d"]->place.trust();
  gate.guests["e"]->place.trust();
  EXPECT_EQ(gate.come("f", "z"), "-");
  EXPECT_EQ(gate.admission.num_sockets(), 4U);
  gate.guests["a"] = nullptr;
  EXPECT_EQ(gate.admission.num_sockets(), 3U);
  EXPECT_EQ(gate.come("f", "z"), "");
}

// One address cannot take the places of others.
TEST(Admission, TakesPlacesFromTheAddressWithMostGuests) {
  Gate gate{4, 100};
  EXPECT_EQ(gate.come("a", "x"), "");
  for (const auto* name : {"b", "c", "d"}) EXPECT_EQ(gate.come(name, "y"), "");
  EXPECT_EQ(gate.come("e", "z"), "b");
  EXPECT_EQ(gate.come("f", "y"), "c");
  EXPECT_EQ(gate.admission.num_sockets(), 4U);
}

// Giving way and leaving at the same time count once.
TEST(Admission, CountsAPlaceOnce) {
  Gate gate{2, 1};
  EXPECT_EQ(gate.come("a", "x"), "");
  EXPECT_EQ(gate.come("b", "x"), "a");
  EXPECT_EQ(gate.admission.num_sockets(), 1U);
  gate.guests["a"]->place.renew();
  gate.guests["a"]->place.trust();
  gate.guests["a"] = nullptr;
  EXPECT_EQ(gate.admission.num_sockets(), 1U);
  gate.guests["b"] = nullptr;
  EXPECT_EQ(gate.admission.num_sockets(), 0U);
}

TEST(Admission, TakesANetworkOfIpv6ForOneAddress) {
  EXPECT_EQ(address_group("2001:db8:1:2:3:4:5:6"), address_group("2001:db8:1:2::1"));
  EXPECT_NE(address_group("2001:db8:1:2::1"), address_group("2001:db8:1:3::1"));
  EXPECT_EQ(address_group("::ffff:192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(address_group("192.0.2.1"), "192.0.2.1");
}

TEST(Site, KnowsItsNames) {
  const Site site{{"study.example.org", "192.0.2.7", "2001:db8::1"}, {"https://other.example"}};
  for (const char* host : {"localhost", "LOCALHOST:80", "127.0.0.1:8642", "[::1]", "study.example.org.", "192.0.2.7:1",
                           "[2001:db8::1]:443"}) {
    EXPECT_TRUE(site.is_ours(host)) << host;
  }
  for (const char* host : {"", "evil.example", "localhost.evil.example", "study.example.org:80:80", "[::1",
                           "127.0.0.1:x", "a b", "localhost:123456", "user@localhost"}) {
    EXPECT_FALSE(site.is_ours(host)) << host;
  }
}

TEST(Site, LetsItsOwnPagesTalk) {
  const Site site{{}, {"https://Study.example"}};
  EXPECT_TRUE(site.may_talk("http://localhost:8642", "localhost:8642"));
  EXPECT_TRUE(site.may_talk("https://LOCALHOST", "localhost"));
  EXPECT_TRUE(site.may_talk("https://study.example", "localhost:8642"));
  EXPECT_FALSE(site.may_talk("http://localhost:3000", "localhost:8642"));
  EXPECT_FALSE(site.may_talk("null", "localhost"));
  EXPECT_FALSE(site.may_talk("", "localhost"));
}

// However a stream of requests is cut into pieces, the same requests come out of it.
TEST(RequestReader, DoesNotDependOnHowBytesArrive) {
  const std::string stream =
      "\r\nGET /a HTTP/1.1\r\nHost: x\r\n\r\nPOST /b HTTP/1.1\r\nHost: x\r\nContent-Length: 3\r\n\r\nabc"
      "POST /c HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n3\r\ndef\r\n0\r\n\r\nGET /d HTTP/1.1\r\nbad";
  const auto read = [&](std::size_t piece) {
    RequestReader reader{ServerLimits{}};
    std::string found;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      reader.feed(std::string_view{stream}.substr(at, piece));
      while (reader.state() == RequestReader::State::kDone) {
        const auto request = reader.take();
        found += std::string{request.target()} + "=" + request.body() + ";";
      }
    }
    return found + std::to_string(static_cast<int>(reader.state()));
  };
  EXPECT_EQ(read(stream.size()), "/a=;/b=abc;/c=def;1");
  for (std::size_t piece = 1; piece < stream.size(); ++piece) EXPECT_EQ(read(piece), read(stream.size())) << piece;
}

}  // namespace
}  // namespace kith
