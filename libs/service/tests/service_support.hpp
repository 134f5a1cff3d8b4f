#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/live/room_event.hpp"
#include "kith/live/world_json.hpp"
#include "kith/service/live_service.hpp"
#include "kith/store/session_study.hpp"
#include "kith/study/study_file.hpp"
#include "scratch_folder.hpp"

namespace kith::testing {

/// A study of item delivery that is quick to teach. @param group  the lines of its section [group].
[[nodiscard]] inline SessionStudy small_study(const std::string& group = "",
                                              const std::string& compositions = "\"NNP\"", std::size_t particles = 200,
                                              const std::string& strategies = "\"common\"") {
  const std::string text =
      "schema = \"kith.study/1\"\nid = \"small\"\ntitle = \"small\"\ndomain = \"item-delivery\"\nseed = 7\n"
      "replicates = 3\n[design]\nstrategies = [" +
      strategies + "]\ncompositions = [" + compositions +
      "]\n[learner.N]\nlabel = \"novice\"\nability = { mean = 0.703, sd = 0.034 }\n"
      "confirm_gain = { half_normal = 0.033 }\ncorrect_gain = { half_normal = 0.056 }\n"
      "[learner.P]\nlabel = \"proficient\"\nability = { mean = 0.809, sd = 0.025 }\n"
      "confirm_gain = { half_normal = 0.022 }\ncorrect_gain = { half_normal = 0.052 }\n"
      "[teacher]\ncounterfactuals = 4\nparticles = " +
      std::to_string(particles) + "\n[group]\n" + group;
  const auto reading = parse_study(text, "small.toml");
  if (!reading.study) throw Error{reading.diagnostics};
  return make_session_study(reading);
}

/// A clock that moves when it is told to.
class FakeClock {
 public:
  [[nodiscard]] std::int64_t now_us() const { return now_; }
  void advance_ms(std::int64_t ms) { now_ += ms * 1000; }

 private:
  std::atomic<std::int64_t> now_ = 1'700'000'000'000'000;
};

/// A connection that keeps what it is sent.
class FakeSocket final : public LiveService::Socket {
 public:
  void send(std::shared_ptr<const std::string> frame) override {
    const std::lock_guard lock{mutex_};
    frames_.push_back(*frame);
  }
  void close(std::uint16_t code, std::string reason) override {
    const std::lock_guard lock{mutex_};
    close_code_ = code;
    close_reason_ = std::move(reason);
  }
  void authenticated() override { is_authenticated_ = true; }
  /// What came since the last call.
  [[nodiscard]] std::vector<Json> take() {
    const std::lock_guard lock{mutex_};
    std::vector<Json> frames;
    for (const auto& text : std::exchange(frames_, {})) frames.push_back(Json::parse(text));
    return frames;
  }
  [[nodiscard]] std::optional<std::uint16_t> close_code() const {
    const std::lock_guard lock{mutex_};
    return close_code_;
  }
  [[nodiscard]] std::string close_reason() const {
    const std::lock_guard lock{mutex_};
    return close_reason_;
  }
  [[nodiscard]] bool is_authenticated() const { return is_authenticated_; }

 private:
  mutable std::mutex mutex_;
  std::atomic<bool> is_authenticated_ = false;
  std::vector<std::string> frames_;
  std::optional<std::uint16_t> close_code_;
  std::string close_reason_;
};

/// Knows paths through the worlds of a study: the robot's, and the shortest.
class Solver {
 public:
  explicit Solver(std::shared_ptr<const LiveStudy> study) : study_{std::move(study)} {
    const auto& atlas = *study_->atlas;
    for (std::size_t i = 0; i < atlas.num_states(); ++i) {
      const auto id = atlas.id(StartIndex{i});
      if (!atlas.is_candidate(StartIndex{i})) continue;
      const auto state = world_state(*study_, id.mdp, id.start);
      if (!state) continue;
      demos_.emplace(std::pair{world_key(*study_, id.mdp), *state}, StartIndex{i});
    }
  }

  [[nodiscard]] std::vector<std::size_t> robots_path(const std::string& world, std::size_t start) const {
    std::vector<std::size_t> actions;
    for (const auto action : study_->atlas->trajectory(demos_.at({world, start})).actions)
      actions.push_back(action.value());
    return actions;
  }

  [[nodiscard]] std::vector<std::size_t> shortest_path(const std::string& world, std::size_t start) {
    auto found = tables_.find(world);
    if (found == tables_.end()) {
      found = tables_.emplace(world, world_json(*study_, world_of_key(*study_, world).value())).first;
    }
    const auto& next = found->second.at("next");
    const auto& end = found->second.at("end");
    std::map<std::size_t, std::pair<std::size_t, std::size_t>> from{{start, {start, 0}}};
    std::queue<std::size_t> open;
    open.push(start);
    while (!open.empty()) {
      const auto state = open.front();
      open.pop();
      if (end.at(state).get<bool>()) {
        std::deque<std::size_t> actions;
        for (auto at = state; at != start; at = from.at(at).first) actions.push_front(from.at(at).second);
        return {actions.begin(), actions.end()};
      }
      for (std::size_t action = 0; action < next.at(state).size(); ++action) {
        const auto to = next.at(state).at(action).get<std::int64_t>();
        if (to < 0 || !from.emplace(static_cast<std::size_t>(to), std::pair{state, action}).second) continue;
        open.push(static_cast<std::size_t>(to));
      }
    }
    throw std::logic_error{"no end can be reached"};
  }

 private:
  std::shared_ptr<const LiveStudy> study_;
  std::map<std::pair<std::string, std::size_t>, StartIndex> demos_;
  std::map<std::string, Json> tables_;
};

/// A page of a participant: keeps what is not acknowledged and sends it again, as browsers do.
class Page {
 public:
  struct Message {
    std::string id;
    std::string type;
    Json body;
  };

  Page(std::string token, std::string name) : token_{std::move(token)}, name_{std::move(name)} {}

  void connect(LiveService& service) {
    socket_ = std::make_shared<FakeSocket>();
    connection_ = service.open(socket_);
    service.receive(connection_, Json{{"t", "hello"}, {"v", 1}, {"token", token_}, {"tab", name_}}.dump());
    for (const auto& message : unsaved_) send(service, message);
  }
  /// The connection is lost.
  void disconnect(LiveService& service) {
    if (socket_) service.closed(connection_);
    socket_.reset();
  }
  /// The server is gone.
  void lose() { socket_.reset(); }
  [[nodiscard]] bool is_connected() const { return socket_ && !socket_->close_code(); }

  /// Reads what came.
  void read() {
    if (!socket_) return;
    for (const auto& frame : socket_->take()) {
      const auto type = frame.at("t").get<std::string>();
      if (type == "view") {
        const auto rooms = view_.is_object() ? view_.value("rooms", Json{}) : Json{};
        views_.push_back(view_ = frame.at("view"));
        if (!view_.contains("rooms") && !rooms.is_null()) view_["rooms"] = rooms;
      }
      if (type == "bye") bye_ = frame.at("reason");
      if (type == "ack" || type == "nak") {
        const auto id = frame.at("id").get<std::string>();
        (type == "ack" ? acks_ : naks_).push_back(id);
        if (type == "nak") last_nak_ = frame;
        std::erase_if(unsaved_, [&](const Message& message) { return message.id == id; });
      }
    }
  }

  /// Sends a message and keeps it until it is answered.
  std::string ask(LiveService& service, const std::string& type, Json body) {
    Message message{.id = name_ + "-" + std::to_string(++number_), .type = type, .body = std::move(body)};
    unsaved_.push_back(message);
    if (is_connected()) send(service, message);
    return message.id;
  }
  void send(LiveService& service, const Message& message) const {
    service.receive(connection_, Json{{"t", message.type}, {"id", message.id}, {"body", message.body}}.dump());
  }
  void beat(LiveService& service) const {
    if (is_connected()) service.receive(connection_, R"({"t":"beat"})");
  }

  [[nodiscard]] const Json& view() const { return view_; }
  [[nodiscard]] const std::vector<Json>& views() const { return views_; }
  [[nodiscard]] std::string stage() const { return view_.is_object() ? view_.value("stage", "") : ""; }
  [[nodiscard]] const std::vector<std::string>& acks() const { return acks_; }
  [[nodiscard]] const std::vector<std::string>& naks() const { return naks_; }
  [[nodiscard]] const Json& last_nak() const { return last_nak_; }
  [[nodiscard]] const std::vector<Message>& unsaved() const { return unsaved_; }
  [[nodiscard]] const std::string& bye() const { return bye_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] FakeSocket* socket() const { return socket_.get(); }
  [[nodiscard]] LiveService::ConnectionId connection() const { return connection_; }

 private:
  std::string token_;
  std::string name_;
  std::shared_ptr<FakeSocket> socket_;
  LiveService::ConnectionId connection_ = 0;
  std::size_t number_ = 0;
  Json view_;
  std::vector<Json> views_;
  std::vector<std::string> acks_, naks_;
  Json last_nak_;
  std::vector<Message> unsaved_;
  std::string bye_;
};

[[nodiscard]] inline bool is_terminal(const std::string& stage) {
  static const std::set<std::string> kTerminal{"debrief", "declined", "full", "ended", "replaced"};
  return kTerminal.count(stage) != 0;
}

/// What a participant does next, given the page; nothing while there is nothing to do.
/// @param is_right  whether an answer is the robot's path rather than the shortest one.
[[nodiscard]] inline std::optional<std::pair<std::string, Json>> next_step(const Json& view, Solver& solver,
                                                                           bool is_right) {
  if (!view.is_object()) return std::nullopt;
  const auto stage = view.value("stage", std::string{});
  if (stage == "consent")
    return std::pair{std::string{"consent"}, Json{{"accept", true}, {"version", view["consent"]["version"]}}};
  if (stage == "check") return std::pair{std::string{"checked"}, Json::object()};
  const auto round = view.value(Json::json_pointer{"/progress/round"}, 0);
  if (stage == "watch")
    return std::pair{std::string{"watched"}, Json{{"demo", view["watch"]["index"]}, {"round", round}}};
  if (stage == "predict" || stage == "screening" || stage == "exam") {
    const auto& predict = view["predict"];
    const auto world = predict["world"].get<std::string>();
    const auto start = predict["start"].get<std::size_t>();
    const auto path = is_right ? solver.robots_path(world, start) : solver.shortest_path(world, start);
    Json keys = Json::array();
    for (std::size_t i = 0; i < path.size(); ++i) keys.push_back({path[i], 200 * (i + 1)});
    Json body{{"test", predict["index"]}, {"actions", path}, {"ms", 200 * path.size()}};
    if (stage == "screening") return std::pair{std::string{"screen"}, body};
    if (stage == "exam") return std::pair{std::string{"examine"}, body};
    body["keys"] = keys;
    body["round"] = round;
    return std::pair{std::string{"answer"}, body};
  }
  if (stage == "feedback") return std::pair{std::string{"continue"}, Json{{"round", round}}};
  if (stage == "questions") {
    Json answers = Json::object();
    for (const auto& item : view["questions"]["items"]) {
      const auto kind = item.value("kind", std::string{});
      answers[item["id"].get<std::string>()] = kind == "likert"   ? Json(4)
                                               : kind == "choice" ? item["options"][0]
                                                                  : Json("It was Wilhelmina's idea.");
    }
    return std::pair{std::string{"questions"}, Json{{"answers", answers}}};
  }
  return std::nullopt;
}

/// A server with its clock, on a folder.
class Stage {
 public:
  Stage(const std::filesystem::path& folder, SessionStudy study) : folder_{folder}, study_{std::move(study)} {
    start();
  }

  void start() {
    LiveServiceOptions options;
    options.folder = folder_;
    options.inputs = study_.inputs;
    options.digest = study_.digest;
    options.program = "kith test";
    options.joins_per_minute = 0;
    options.wrong_codes_per_minute = 0;
    options.teaching_workers = 1;
    options.now_us = [this] { return clock_.now_us(); };
    options.ticks = false;
    options.free_bytes = [this](const std::filesystem::path&) { return free_bytes.load(); };
    if (change_options) change_options(options);
    service_.emplace(study_.study, options);
    service_->set_base_url("http://test");
    facilitator_ = service_->start_links().facilitator;
    service_->settle();
  }
  void stop() { service_.reset(); }
  void restart() {
    stop();
    start();
  }

  [[nodiscard]] LiveService& service() { return *service_; }
  [[nodiscard]] FakeClock& clock() { return clock_; }
  [[nodiscard]] const SessionStudy& study() const { return study_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::string& facilitator_token() const { return facilitator_; }

  /// Lets time pass, in steps of at most a second, and everything happen that is due.
  void pass_ms(std::int64_t ms) {
    while (ms > 0) {
      const auto step = std::min<std::int64_t>(ms, 1000);
      clock_.advance_ms(step);
      ms -= step;
      service_->tick();
      service_->settle();
    }
  }

  LiveService::HttpReply get(const std::string& target, const std::string& token = "") {
    return ask({.method = "GET", .target = target, .bearer = token, .body = "", .remote = "test"});
  }
  LiveService::HttpReply post(const std::string& target, const Json& body, const std::string& token = "") {
    return ask({.method = "POST", .target = target, .bearer = token, .body = body.dump(), .remote = "test"});
  }
  LiveService::HttpReply ask(LiveService::HttpRequest request) {
    auto reply = std::make_shared<std::promise<LiveService::HttpReply>>();
    auto answer = reply->get_future();
    service_->http(std::move(request),
                   [reply = std::move(reply)](LiveService::HttpReply given) { reply->set_value(std::move(given)); });
    return answer.get();
  }
  /// Takes a seat under that code. @return the token, or "" if there is none.
  std::string join(const std::string& code, const Json& query = Json::object()) {
    const auto reply = post("/api/join", {{"code", code}, {"query", query}});
    const auto body = Json::parse(reply.body);
    return body.value("token", std::string{});
  }

  /// A facilitator's page that has seen a view.
  std::unique_ptr<Page> facilitator() {
    auto page = std::make_unique<Page>(facilitator_, "facilitator-" + std::to_string(++facilitators_));
    page->connect(*service_);
    show(*page);
    return page;
  }
  /// Has the facilitator's view brought up to date.
  void show(Page& page) {
    for (int i = 0; i < 3; ++i) {
      service_->tick();
      service_->settle();
    }
    page.read();
  }
  /// The code under which people join the study.
  std::string join_code() {
    const auto page = facilitator();
    const auto code = page->view().at("links").at("code").get<std::string>();
    page->disconnect(*service_);
    return code;
  }

  std::atomic<std::uint64_t> free_bytes = std::uint64_t{1} << 40;
  std::function<void(LiveServiceOptions&)> change_options;

 private:
  std::filesystem::path folder_;
  SessionStudy study_;
  FakeClock clock_;
  std::optional<LiveService> service_;
  std::string facilitator_;
  std::size_t facilitators_ = 0;
};

/// Participants who act until all of them are done. @return whether they are, after at most `rounds` rounds.
inline bool play(Stage& stage, std::vector<std::unique_ptr<Page>>& people, Solver& solver, std::size_t rounds = 2000,
                 const std::function<bool(std::size_t person, const Json& view)>& is_right = {}) {
  for (std::size_t round = 0; round < rounds; ++round) {
    bool is_over = true;
    for (std::size_t i = 0; i < people.size(); ++i) {
      auto& person = *people[i];
      person.read();
      if (is_terminal(person.stage())) continue;
      is_over = false;
      if (!person.unsaved().empty()) continue;
      const auto step = next_step(person.view(), solver, !is_right || is_right(i, person.view()));
      if (step)
        person.ask(stage.service(), step->first, step->second);
      else
        person.beat(stage.service());
    }
    if (is_over) return true;
    stage.service().settle();
    if (round % 4 == 3) stage.pass_ms(100);
  }
  return false;
}

}  // namespace kith::testing
