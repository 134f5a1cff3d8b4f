// The room of one person, for a page: requests and replies are JSON texts.
//
//   {"do": "open", "inputs": {name: text}, "setup": RoomSetup, "events": [...], "now_us"}   a study and what happened
//   {"do": "ask", "type", "body", "now_us"}                                                 a command of the person
//   {"do": "tick", "now_us"}                                                                what is due by the clock
//   {"do": "teach", "now_us"}                                                               the next lesson
//   {"do": "world", "key"}, {"do": "texts"}, {"do": "seal"}         a table of moves, texts, a digest of all events
//   {"do": "progress"}                                              {"predictions", "components"}
//   {"do": "teacher"}                                               {"study", "periods": [{"row", "room"}]}
//   {"do": "play", "inputs", "asked"}                               playground_json() of a study, and its "warnings"
//
// "teacher" is what facilitators see after every period, and now. A room of simulated people begins by itself; every
// "teach" is one of its periods.
//
// A lesson among the events of "open" whose body is null is chosen again; the reply then has all events and what the
// lessons show as {"restored": {"events", "lessons"}}. Only those with "now_us" reply {"events": those that happened,
// "view", "due_us" or null, "teaching": whether a lesson is waited for, "lesson": {"seq", "demos", "tests"} if one was
// chosen, "refusal" or null}; "open" also the "warnings" about its inputs, as texts. Whatever goes wrong is {"error":
// text, "diagnostics": what is wrong with the inputs, as of kith::to_json() and with "text" for people}.
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "kith/core/diagnostic.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/json.hpp"
#include "kith/live/lesson_log.hpp"
#include "kith/live/room.hpp"
#include "kith/live/world_json.hpp"
#include "kith/study/study_file.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

Json texts_of(const std::vector<Diagnostic>& diagnostics) {
  Json texts = Json::array();
  for (const auto& diagnostic : diagnostics) texts.push_back(to_text(diagnostic));
  return texts;
}

Json error_reply(const Error& error) {
  Json list = Json::array();
  for (const auto& diagnostic : error.diagnostics()) {
    list.push_back(to_json(diagnostic));
    list.back()["text"] = to_text(diagnostic);
  }
  return {{"error", error.what()}, {"diagnostics", std::move(list)}};
}

std::string text_of(const Json& reply) { return reply.dump(-1, ' ', true, Json::error_handler_t::replace); }

#ifndef KITH_LESSON_FOLDER
#define KITH_LESSON_FOLDER "/study"  // of the page's own files
#endif
const std::string kFolder = KITH_LESSON_FOLDER;
const std::string kPerson = "seat:1";

class Engine {
 public:
  Json answer(const Json& request) {
    const auto what = request.at("do").get<std::string>();
    if (what == "open") return open(request);
    if (what == "play") return play(request);
    if (!room_) throw std::logic_error{"nothing is open"};
    if (what == "world") return world(request.at("key").get<std::string>());
    if (what == "texts") return language_json(*study_);
    if (what == "progress") return progress();
    if (what == "seal") return {{"seal", seal_}};
    if (what == "teacher") return teacher();
    now_us_ = std::max(now_us_, request.at("now_us").get<std::int64_t>());
    if (what == "ask") return ask(request.at("type").get<std::string>(), request.value("body", Json::object()));
    if (what == "tick") return state();
    if (what == "teach") return teach();
    throw std::invalid_argument{"what is '" + what + "'?"};
  }

 private:
  // @return warnings about the study and its domain, as texts.
  Json read(const Json& inputs) {
    fs::create_directories(kFolder);
    for (const auto& [name, text] : inputs.items()) {
      fs::create_directories((fs::path{kFolder} / name).parent_path());
      std::ofstream{fs::path{kFolder} / name, std::ios::binary} << text.get<std::string>();
    }
    const auto reading = load_study(kFolder + "/study.toml");
    if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
    study_ =
        make_live_study(*reading.study, std::make_shared<const Atlas>(*reading.domain), kFolder, reading.domain_text);
    return texts_of(reading.diagnostics);
  }

  Json play(const Json& request) {
    auto warnings = read(request.at("inputs"));
    auto reply = playground_json(*study_, request.at("asked"));
    reply["warnings"] = std::move(warnings);
    return reply;
  }

  Json open(const Json& request) {
    const auto warnings = read(request.at("inputs"));
    cache_ = std::make_unique<TeachingCache>(study_->atlas);
    room_.emplace(study_, room_setup(request.at("setup")), *cache_);
    past_ = Json::array();
    seal_.clear();
    now_us_ = request.at("now_us").get<std::int64_t>();
    Json lessons = Json::array();
    for (const auto& event : request.value("events", Json::array())) {
      if (event.at("body").is_null()) {
        lessons.push_back(teach_next(event.at("at_us").get<std::int64_t>()));
      } else {
        happen(room_event(event));
      }
    }
    auto restored = Json{{"events", std::exchange(happened_, Json::array())}, {"lessons", lessons}};
    if (room_->is_person(1)) {
      if (room_->seq() == 0) decide({"server", "join", {{"seat", 1}}, {}});
      decide({"server", "present", {{"seat", 1}}, {}});
    }
    auto reply = state();
    if (!lessons.empty()) reply["restored"] = std::move(restored);
    reply["warnings"] = warnings;
    return reply;
  }

  Json ask(const std::string& type, Json body) {
    const auto refusal = decide({kPerson, type, std::move(body), {}});
    auto reply = state();
    if (refusal) reply["refusal"] = {{"reason", refusal->reason}, {"text", refusal->text}};
    return reply;
  }

  Json teach() {
    if (!room_->teaching()) return state();
    auto lesson = teach_next(now_us_);
    auto reply = state();
    reply["lesson"] = std::move(lesson);
    return reply;
  }

  // @return what it shows and asks.
  Json teach_next(std::int64_t at_us) {
    const auto task = room_->teaching();
    if (!task) throw Error{ErrorKind::kMismatch, "there is no lesson to be chosen"};
    const auto lesson = task->run(*cache_);
    const auto event = room_->taught(lesson, at_us);
    happen(event, &lesson);
    return lesson_content(lesson, event.seq);
  }

  // As facilitators see it, without what a clock has to say.
  Json picture() const {
    auto picture = room_->view({Viewer::Role::kFacilitator, 0}, now_us_);
    picture.at("room").at("timers") = Json::array();
    for (auto& seat : picture.at("row").at("seats")) {
      seat["since_ms"] = 0;
      seat.erase("stage_since_ms");
    }
    return picture;
  }

  // A period that cannot be shown is left out: the person is taught all the same.
  void keep_picture() {
    try {
      past_.push_back(picture());
    } catch (const std::exception&) {
    }
  }

  Json teacher() const {
    auto periods = past_;
    periods.push_back(picture());
    return {{"study", live_study_json(*study_)}, {"periods", std::move(periods)}};
  }

  // How far the person is, for learning systems.
  Json progress() const {
    const auto room = room_->view({Viewer::Role::kFacilitator, 0}, now_us_).at("room");
    return {{"predictions", room.at("answers")}, {"components", room.at("session").at("components")}};
  }

  std::optional<Refusal> decide(const RoomCommand& command) {
    auto decision = room_->decide(command, now_us_);
    for (const auto& event : decision.events) happen(event);
    return decision.refusal;
  }

  void happen(const RoomEvent& event, const TaughtLesson* lesson = nullptr) {
    const bool ends_period = event.get<happening::LessonChosen>() != nullptr && room_->session().periods() > 0;
    if (ends_period) keep_picture();
    room_->apply(event, *cache_, lesson);
    seal_ = sealed(seal_, event);
    happened_.push_back(to_json(event));
  }

  // After what is due by the clock.
  Json state() {
    for (auto due = room_->due(now_us_); !due.empty(); due = room_->due(now_us_)) {
      for (const auto& event : due) happen(event);
    }
    const auto next = room_->next_due();
    const bool is_watched = room_->is_person(1);
    Json reply{{"events", std::exchange(happened_, Json::array())},
               {"view", is_watched ? room_->view({Viewer::Role::kParticipant, 1}, now_us_) : Json{}},
               {"due_us", next ? Json{*next} : Json{}},
               {"teaching", room_->teaching().has_value()},
               {"refusal", Json{}}};
    return reply;
  }

  Json world(const std::string& key) const {
    const auto number = world_of_key(*study_, key);
    if (!number) throw std::invalid_argument{"no world " + key};
    return world_json(*study_, *number);
  }

  std::shared_ptr<const LiveStudy> study_;
  std::unique_ptr<TeachingCache> cache_;
  std::optional<Room> room_;
  std::int64_t now_us_ = 0;
  Json happened_ = Json::array();
  Json past_ = Json::array();  // pictures after every period but the last
  std::string seal_;
};

}  // namespace
}  // namespace kith

extern "C" const char* kith_engine(const char* request) {
  static kith::Engine engine;  // one per worker
  static std::string reply;
  try {
    reply = kith::text_of(engine.answer(kith::Json::parse(request)));
  } catch (const kith::Error& error) {
    reply = kith::text_of(kith::error_reply(error));
  } catch (const std::exception& error) {
    reply = kith::text_of({{"error", error.what()}});
  }
  return reply.c_str();
}
