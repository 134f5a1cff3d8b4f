// kith serve: teaches groups of real people.
#include <fmt/format.h>
#include <malloc.h>
#include <spawn.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "build_facts.hpp"
#include "command.hpp"
#include "embedded.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/core/parallel_loop.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/temporary_folder.hpp"
#include "kith/service/live_service.hpp"
#include "kith/service/server.hpp"
#include "kith/store/session_study.hpp"
#include "serve_address.hpp"
#include "serve_rehearsal.hpp"
#include "web_assets.hpp"
#include "work_notice.hpp"

extern char** environ;

namespace kith::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPoll{50};
constexpr std::chrono::milliseconds kGoodbye{400};
constexpr std::size_t kDemoPeople = 3;
constexpr std::uint16_t kPort = 8642;
constexpr std::uint16_t kAnyPort = 0;

// What threads of the server report, until the main thread shows it. Each sentence once in ten seconds.
class NoticeBoard {
 public:
  void add(const ServerNotice& notice) {
    const auto now = std::chrono::steady_clock::now();
    const std::lock_guard lock{mutex_};
    auto& last = shown_[notice.text];
    if (last != std::chrono::steady_clock::time_point{} && now - last < std::chrono::seconds{10}) return;
    last = now;
    if (shown_.size() > kMany) shown_.clear();
    waiting_.push_back(notice.text);
  }
  void show(Console& console) {
    std::vector<std::string> now;
    {
      const std::lock_guard lock{mutex_};
      now.swap(waiting_);
    }
    for (const auto& text : now) console.warning(text);
  }

 private:
  static constexpr std::size_t kMany = 100;
  std::mutex mutex_;
  std::map<std::string, std::chrono::steady_clock::time_point> shown_;
  std::vector<std::string> waiting_;
};

void check_options(const ServeOptions& options) {
  if (options.demo == !options.study.empty()) {
    refuse(options.demo ? "--demo has a study of its own; leave out " + options.study
                        : "kith serve needs a study, or --demo");
  }
  if (options.out.empty() && !options.demo && options.rehearse == 0) {
    refuse("kith serve needs -o DIR, the folder for the answers");
  }
  if (options.restart_after > 0.0 && options.for_seconds > 0.0 && options.restart_after >= options.for_seconds) {
    refuse("the rehearsal is over before --restart-after; choose a time less than --for");
  }
  if (web_assets().empty() && options.rehearse == 0) {
    throw Error{ErrorKind::kInfeasible, "this program was built without pages for browsers",
                Advice{"install Node.js and npm and build it again"}};
  }
}

StudyReading reading_of(const ServeOptions& options) {
  if (!options.demo) return study_of(options.study, options.set);
  auto reading =
      parse_study(detail::kDemoStudy, "the study of --demo", {.overrides = options.set, .override_name = "--set"});
  if (!reading.study) throw Error{reading.diagnostics};
  return reading;
}

// Where files that the study names are looked for.
fs::path folder_of(const ServeOptions& options) {
  std::error_code ignored;
  return fs::is_regular_file(options.study, ignored) ? fs::path{options.study}.parent_path() : fs::path{};
}

// A participant is one open file, and in a rehearsal two.
void raise_file_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

// With an arena for every thread, glibc keeps what a thread has freed from the others: 200 groups took 182 MB after the
// server had been restarted for 139.
void share_freed_memory() {
#ifdef M_ARENA_MAX
  mallopt(M_ARENA_MAX, 2);  // NOLINT(concurrency-mt-unsafe): before there are other threads
#endif
}

LiveServiceOptions service_options(const ServeOptions& options, const SessionStudy& session, const fs::path& folder) {
  LiveServiceOptions service;
  service.inputs = session.inputs;
  service.digest = session.digest;
  service.folder = folder;
  service.program = program_name();
  service.teaching_workers = default_num_workers();
  service.joins_per_minute = options.join_limit;
  service.max_rooms = std::max(service.max_rooms, options.rooms + options.rehearse);
  // In a rehearsal of a given length new groups follow those that finish.
  if (options.rehearse > 0) service.max_rooms = std::numeric_limits<std::size_t>::max() / 2;
  return service;
}

ServerOptions server_options(const ServeOptions& options, const ServeAddress& address, NoticeBoard& board) {
  ServerOptions server;
  server.bind = address.bind;
  server.port = options.port.value_or(options.rehearse > 0 ? kAnyPort : kPort);
  server.io_threads = default_num_workers();
  server.hosts = address.hosts;
  server.origins = address.origins;
  server.behind_proxy = address.behind_proxy;
  server.proxy = options.trusted_proxy;
  server.limits.unauthenticated_per_address = options.connections_per_address;
  server.assets = web_assets();
  const auto has = [&](const std::string& path) {
    return std::any_of(server.assets.begin(), server.assets.end(), [&](const Asset& one) { return one.path == path; });
  };
  const auto add = [&](const std::string& page, const std::string& path) {
    if (has(path)) server.pages.emplace(page, path);
  };
  add("/", "/assets/live/landing.html");
  add("/", "/assets/live/index.html");
  add("/j", "/assets/live/index.html");
  add("/f", "/assets/facilitator/index.html");
  server.on_notice = [&board](const ServerNotice& notice) { board.add(notice); };
  if (options.rehearse > 0) {  // everybody comes from this machine at once
    server.limits.unauthenticated_per_address = 3 * options.rehearse * 30;
    server.limits.sockets = std::max(server.limits.sockets, 4 * options.rehearse * 30);
  }
  return server;
}

// What whoever started the server needs.
struct Links {
  std::string facilitator;
  std::string observer;
  std::string join;
  std::string code;
  std::vector<std::string> seats{};  // of the demonstration
};

void print_links(const Links& links, const fs::path& folder, std::uint16_t port, Console& console) {
  if (console.json()) {
    Json document{{"schema", "kith.serve/1"},
                  {"port", port},
                  {"facilitator", links.facilitator},
                  {"observer", links.observer},
                  {"join", links.join},
                  {"code", links.code},
                  {"seats", links.seats},
                  {"folder", folder.string()}};
    console.print_json(document);
    return;
  }
  std::string text = "facilitator  " + links.facilitator + "\n";
  text += "observer     " + links.observer + "\n";
  if (links.seats.empty()) text += "participants " + links.join + "   (code " + links.code + ")" + "\n";
  for (std::size_t i = 0; i < links.seats.size(); ++i) text += fmt::format("person {}     {}\n", i + 1, links.seats[i]);
  text += "data         " + folder.string() + "\n";
  console.print(text);
}

// A desktop has a display and a program that opens links.
void open_in_browser(const std::vector<std::string>& links) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  for (auto link : links) {
    std::string program = "xdg-open";
    char* arguments[] = {program.data(), link.data(), nullptr};
    pid_t child = 0;
    if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds{500});  // in this order, in one window
  }
}

// The server of a session, from the port down to the folder, which can be restarted.
class LiveServer {
 public:
  LiveServer(std::shared_ptr<const LiveStudy> study, LiveServiceOptions service, ServerOptions server,
             const ServeAddress& address)
      : study_{std::move(study)},
        service_options_{std::move(service)},
        server_options_{std::move(server)},
        address_{address} {
    start();
  }

  [[nodiscard]] LiveService& service() { return running_->service; }
  [[nodiscard]] std::uint16_t port() const { return running_->server.port(); }
  [[nodiscard]] std::string base() const { return base_url(address_, port()); }

  void stop() {
    running_->server.stop(kGoodbye);
    running_->service.stop();
  }
  // At the same port and in the same folder: nothing but what is on the disk is kept.
  void restart() {
    stop();
    server_options_.port = port();
    running_.reset();
    start();
  }

 private:
  struct Running {
    Running(std::shared_ptr<const LiveStudy> study, const LiveServiceOptions& service_options,
            const ServerOptions& server_options)
        : service{std::move(study), service_options}, server{server_options, service} {}
    LiveService service;
    Server server;
  };

  void start() {
    running_.emplace(study_, service_options_, server_options_);
    running_->service.set_base_url(base());
  }

  std::shared_ptr<const LiveStudy> study_;
  LiveServiceOptions service_options_;
  ServerOptions server_options_;
  ServeAddress address_;
  std::optional<Running> running_;
};

void serve_until_stopped(NoticeBoard& board, Console& console) {
  while (stop_signal() == 0) {
    board.show(console);
    std::this_thread::sleep_for(kPoll);
  }
}

void declare(OptionList& list, ServeOptions& options) {
  list.study(options.study);
  list.text("-o,--out", options.out, "DIR", "Folder for the answers; a session in it is resumed");
  list.set(options.set);
  list.integer("--port", options.port, {0, 65535},
               "Port to listen at; 0: any that is free (default: 8642, and 0 for a rehearsal)");
  list.text("--bind", options.bind, "ADDRESS", "Address to listen at (default: 127.0.0.1, this machine only)");
  auto lan = list.flag("--lan", options.lan, "Listen at all addresses of this machine");
  list.flag("--insecure-lan", options.insecure_lan, "With --lan: accept that nothing is encrypted").needs(lan);
  auto url = list.text("--public-url", options.public_url, "URL", "Address of the reverse proxy that people use");
  list.text("--trusted-proxy", options.trusted_proxy, "ADDRESS",
            "With --public-url: address of a proxy on another machine")
      .needs(url);
  list.integer("--connections-per-address", options.connections_per_address, {8, 1'000'000},
               "Connections per address that have not shown a valid link");
  list.integer("--rooms", options.rooms, {0, 2000}, "Make rooms until there are N; others are made as people join");
  list.integer("--join-limit", options.join_limit, {0, 1'000'000}, "Joins per minute from one address; 0: no limit");
  auto demo = list.flag("--demo", options.demo, "A first look: a robot to understand, and a room for three");
  list.flag("--no-browser", options.no_browser, "With --demo: do not open a browser").needs(demo);
  auto rehearse = list.integer("--rehearse", options.rehearse, {1, 5000},
                               "Teach N groups of simulated people instead, and time it");
  const NumberRange any_time{0.0, kLargestNumber};
  list.number("--for", options.for_seconds, "SECONDS", any_time,
              "With --rehearse: seconds (default: 0, until everybody has finished)")
      .needs(rehearse);
  list.number("--answer-every", options.answer_every, "SECONDS", {0.0, kLargestNumber, NumberRange::kAbove},
              "With --rehearse: seconds that a person takes for an answer")
      .needs(rehearse);
  list.number("--reconnects", options.reconnects, "P", {},
              "With --rehearse: share of people who reconnect every second (default: 0)")
      .needs(rehearse);
  list.number("--restart-after", options.restart_after, "SECONDS", any_time,
              "With --rehearse: stop the server after so many seconds and start it again (default: 0, never)")
      .needs(rehearse);
  list.json();
}

int run(const ServeOptions& options, Console& console) {
  check_options(options);
  const auto address = serve_address(options);
  for (const auto& warning : address.warnings) console.warning(warning);
  const auto reading = reading_of(options);
  if (!console.quiet()) {
    show_warnings(reading, console);
    console.show(warnings_for_people(reading.study->variants.front(), folder_of(options)));
  }
  watch_signals();
  raise_file_limit();
  share_freed_memory();

  std::optional<WorkNotice> notice{std::in_place, console, "planning " + reading.domain->id()};
  const auto session = make_session_study(reading, folder_of(options));
  notice.reset();

  std::optional<TemporaryFolder> temporary;
  if (options.out.empty()) temporary.emplace("kith-session");
  const auto folder = temporary ? temporary->path() : fs::path{options.out};
  NoticeBoard board;
  RehearsalResult rehearsed;
  RehearsalRecord record;
  {
    if (options.rehearse == 0) expect_to_be_stopped();
    LiveServer server{session.study, service_options(options, session, folder), server_options(options, address, board),
                      address};
    const auto tokens = server.service().start_links();
    if (options.rehearse > 0) {
      console.info("rehearsing; Ctrl-C ends it early");
      rehearsed = rehearse(rehearsal_options(
          options, session.study, server.port(), tokens, [&server] { server.restart(); }, record));
    } else {
      const auto base = server.base();
      auto& service = server.service();
      Links links{.facilitator = base + "/f#t=" + tokens.facilitator,
                  .observer = base + "/f#t=" + tokens.observer,
                  .join = base + "/j?code=" + tokens.code,
                  .code = tokens.code};
      // A room of its own for every start: the links of earlier ones are known to those who have them only.
      if (options.demo) {
        const std::vector<std::string> persons(kDemoPeople, "person");
        for (const auto& token : service.make_rooms(1, persons)) links.seats.push_back(base + "/j#t=" + token);
      }
      const auto there = service.num_rooms();
      if (there < options.rooms) service.make_rooms(options.rooms - there);
      print_links(links, folder, server.port(), console);
      console.info("the facilitator's link gives control over the session: keep it to yourself");
      console.info(temporary ? "Ctrl-C stops the server and deletes the data; to keep them, name a folder with -o"
                             : "Ctrl-C stops the server; rerun the command to resume the session");
      if (options.demo && !options.no_browser) {
        auto all = links.seats;
        all.insert(all.begin(), links.facilitator);
        open_in_browser(all);
      }
      serve_until_stopped(board, console);
    }
    server.stop();
    board.show(console);
  }
  if (options.rehearse > 0) {
    return report_rehearsal(options, rehearsed, record, look_up(rehearsed.answers, folder), console);
  }
  console.info(temporary ? "stopped" : "stopped; everything is saved in " + options.out);
  return 0;
}

}  // namespace

void add_serve(Commands& commands) {
  commands.add<ServeOptions>(
      "serve", "Teach groups of real people in their browsers",
      {"kith serve --demo", "kith serve study.toml -o results/live", "kith serve study.toml --rehearse 20 --for 60"},
      declare, run);
}

}  // namespace kith::cli
