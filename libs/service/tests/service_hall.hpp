#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "service_group.hpp"

namespace kith::testing {

inline constexpr const char* kScreened =
    "screening = { tests = 2, cut = 0.6, high = \"P\" }\ncollect_query = [\"PID\"]\n";

/// A server whose study screens people, for groups of two novices and somebody able.
struct Screened : Hosted {
  explicit Screened(const std::string& section = "", const std::string& compositions = "\"NNP\"")
      : Hosted{small_study(kScreened + section, compositions)} {}

  /// Somebody comes by the study's link, and is screened.
  Page& come(const std::string& name, bool is_able) {
    const auto token = stage.join(stage.join_code(), {{"PID", "pid-" + name}});
    EXPECT_FALSE(token.empty());
    people.push_back(std::make_unique<Page>(token, name));
    auto& page = *people.back();
    page.connect(stage.service());
    settle();
    for (int i = 0; i < 20 && page.stage() != "lobby" && page.stage() != "watch"; ++i) {
      if (const auto step = next_step(page.view(), solver, true); step && page.unsaved().empty()) {
        auto body = step->second;
        if (page.stage() == "screening" && !is_able) body["actions"] = Json::array();
        page.ask(stage.service(), step->first, body);
      }
      settle();
    }
    return page;
  }
  /// The estimates of a room as facilitators see them, in the order of the seats.
  [[nodiscard]] std::vector<bool> estimates_of(const std::string& room) {
    const auto page = stage.facilitator();
    std::vector<bool> high;
    for (const auto& row : page->view()["rooms"]) {
      if (row["id"] != room) continue;
      for (const auto& seat : row["seats"]) high.push_back(seat.value("estimate_is_high", false));
    }
    page->disconnect(stage.service());
    return high;
  }
};

/// Rows of a table below its header.
[[nodiscard]] inline std::size_t num_rows(const std::string& csv) {
  return static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) - 1;
}

}  // namespace kith::testing
