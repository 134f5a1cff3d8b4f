#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "scratch_folder.hpp"

namespace kith::testing {

// What may follow an action on the lake: with the same chance ahead, to the left and to the right.
inline std::string lake_transitions(std::size_t cell, const std::string& lake) {
  constexpr std::array<const char*, 4> kNames{"left", "down", "right", "up"};
  constexpr std::array<int, 4> kColumns{-1, 0, 1, 0};
  constexpr std::array<int, 4> kRows{0, 1, 0, -1};
  constexpr int kSide = 4;
  const int column = static_cast<int>(cell % kSide), row = static_cast<int>(cell / kSide);
  std::string rows;
  for (std::size_t a = 0; a < kNames.size(); ++a) {
    std::map<std::size_t, int> thirds;
    for (const std::size_t turn : {3U, 0U, 1U}) {
      const auto way = (a + turn) % kNames.size();
      const int x = column + kColumns[way], y = row + kRows[way];
      const bool inside = x >= 0 && x < kSide && y >= 0 && y < kSide;
      ++thirds[inside ? static_cast<std::size_t>(y * kSide + x) : cell];
    }
    for (const auto& [next, n] : thirds) {
      const std::string chance = n == 1 ? "0.3333333333333333" : n == 2 ? "0.6666666666666667" : "1";
      rows += "c" + std::to_string(cell) + "," + kNames[a] + ",c" + std::to_string(next) + "," + chance + "," +
              (lake[next] == 'H' ? "1" : "0") + "," + (lake[next] == 'G' ? "1" : "0") + ",1\n";
    }
  }
  return rows;
}

/// The file of a slippery lake of 4 x 4 cells, as in Gymnasium's FrozenLake, with features hole, goal and step.
/// @param prior  entries of [prior], such as "{ step = -1 }".
inline std::string slippery_lake(const std::string& name, const std::string& prior, const std::string& discount) {
  namespace fs = std::filesystem;
  const std::string lake = "SFFFFHFHFFFHHFFG";
  static std::map<std::string, ScratchFolder> folders;
  const fs::path folder = folders[name].path();
  std::string states = "state,name,terminal\n";
  std::string transitions = "state,action,next,probability,hole,goal,step\n";
  for (std::size_t cell = 0; cell < lake.size(); ++cell) {
    const bool is_end = lake[cell] == 'H' || lake[cell] == 'G';
    states += "c" + std::to_string(cell) + ",cell " + std::to_string(cell) + (is_end ? ",true\n" : ",false\n");
    if (!is_end) transitions += lake_transitions(cell, lake);
  }
  std::ofstream{folder / "states.csv"} << states;
  std::ofstream{folder / "transitions.csv"} << transitions;
  std::ofstream{folder / "lake.toml"}
      << "schema = \"kith.domain/1\"\nid = \"lake\"\n[mdp]\ndiscount = " << discount
      << "\nmax_steps = 200\n[model]\nformat = \"csv\"\nstates = \"states.csv\"\n"
         "transitions = \"transitions.csv\"\n[[feature]]\nname = \"hole\"\n[[feature]]\n"
         "name = \"goal\"\n[[feature]]\nname = \"step\"\n[reward]\n"
         "weights = { hole = -20, goal = 30, step = -1 }\n[prior]\nhalfspaces = [ "
      << prior
      << " ]\n[words]\nhole = \"falling into a hole\"\ngoal = \"reaching the goal\"\n"
         "step = \"a step\"\n";
  return (folder / "lake.toml").string();
}

}  // namespace kith::testing
