#include "kith/explain/inspect_svg.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kith/bec/comparison.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/board_svg.hpp"
#include "kith/explain/contrast.hpp"
#include "kith/explain/expected_ways.hpp"
#include "kith/explain/picture.hpp"
#include "kith/explain/region_svg.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/files/file_set.hpp"

namespace kith {
namespace {

constexpr double kGap = 28.0;
constexpr double kCaption = 17.0;  // height of a line
constexpr double kCaptionSize = 12.5;
constexpr double kHeadingSize = 16.0;  // bold letters are a tenth wider
constexpr double kPageWidth = 1200.0;

// Lines of text that fit into a width; at least one.
std::vector<std::string> lines_of(const std::string& text, double width, double size) {
  const auto characters = static_cast<std::size_t>(std::max(12.0, width / svg_text_width("n", size)));
  std::vector<std::string> lines;
  std::string rest = wrapped(text, characters);
  while (true) {
    const auto end = rest.find('\n');
    lines.push_back(rest.substr(0, end));
    if (end == std::string::npos) return lines;
    rest = rest.substr(end + 1);
  }
}

// Boards with captions, as many beside each other as fit, under a heading and above the legend.
class Sheet {
 public:
  Sheet(const BoardSvg& boards, std::string heading)
      : boards_{boards},
        heading_{std::move(heading)},
        width_{std::max(boards.width(), 200.0)},
        columns_{std::max<std::size_t>(1, static_cast<std::size_t>(kPageWidth / (width_ + kGap)))} {}

  void add(Svg board, const std::string& caption) {
    panels_.push_back({std::move(board), lines_of(caption, width_, kCaptionSize)});
  }

  [[nodiscard]] std::string file() const {
    Svg svg;
    const auto used = std::min(columns_, panels_.size());
    const double width = std::max(kGap + static_cast<double>(used) * (width_ + kGap), 420.0);

    double y = 26.0;
    for (const auto& line : lines_of(heading_, width - 2 * kGap, 1.1 * kHeadingSize)) {
      svg.text(kGap, y + 8, line, {{"font-size", svg_number(kHeadingSize)}, {"font-weight", "bold"}});
      y += 22.0;
    }

    y += 10.0;
    for (std::size_t first = 0; first < panels_.size(); first += columns_) {
      std::size_t most = 0;
      for (std::size_t i = first; i < std::min(first + columns_, panels_.size()); ++i) {
        const double x = kGap + static_cast<double>(i - first) * (width_ + kGap);
        svg.add(x, y, panels_[i].board);
        for (std::size_t line = 0; line < panels_[i].caption.size(); ++line) {
          svg.text(x, y + boards_.height() + kCaption * static_cast<double>(line + 1), panels_[i].caption[line],
                   {{"font-size", svg_number(kCaptionSize)}});
        }
        most = std::max(most, panels_[i].caption.size());
      }
      y += boards_.height() + kCaption * static_cast<double>(most) + kGap;
    }

    y += boards_.legend(svg, kGap - 6, y, width - 2 * kGap);
    return svg.file(width, y + 10.0, heading_);
  }

 private:
  struct Panel {
    Svg board;
    std::vector<std::string> caption;
  };
  const BoardSvg& boards_;
  std::string heading_;
  double width_;
  std::size_t columns_;
  std::vector<Panel> panels_;
};

std::string title_of(const Domain& domain) {
  return domain.title().empty() ? domain.id() : domain.id() + ": " + domain.title();
}

template <typename Visit>
void for_each_cell_from_bottom(const GridMap& map, const Visit& visit) {
  for (int y = 1; y <= map.height(); ++y)
    for (int x = 1; x <= map.width(); ++x) visit(Cell{x, y});
}

SvgFile map_picture(const Domain& domain, const GridMap& map, const BoardSvg& boards, MdpIndex m) {
  Sheet sheet{boards, fmt::format("{}, {}", title_of(domain), world_text(domain, m))};
  sheet.add(boards.board(m, map.state(m, domain.initial_state(m))), "");
  return {"map.svg", sheet.file()};
}

std::optional<SvgFile> policy_picture(const Domain& domain, const GridMap& map, const BoardSvg& boards, MdpIndex m) {
  const auto& mdp = domain.mdp(m);
  const auto policy = policy_to_draw(domain, m);
  if (!policy) return std::nullopt;
  const auto& choice_in = policy->choice;
  const auto& path = policy->path;
  Sheet sheet{boards, fmt::format("What the robot does in {} of {}", world_text(domain, m), domain.id())};
  for (const auto& configuration : configurations_on(domain, map, m, path)) {
    auto board = boards.board(m, configuration, true);
    for_each_cell_from_bottom(map, [&](const Cell& cell) {
      const auto state = map.find_state(m, with_robot_at(configuration, cell));
      if (!state || mdp.is_terminal(*state)) return;
      const auto& choice = mdp.choices(*state)[choice_in[state->value()]];
      boards.action(board, cell, domain.action_names()[choice.action.value()]);
    });
    sheet.add(std::move(board), configuration_in_words(map, m, configuration));
  }
  return SvgFile{"policy.svg", sheet.file()};
}

SvgFile region_picture(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  auto region = atlas.prior_cone();
  static_cast<void>(region.clip(atlas.policy_bec_half_spaces()));
  RegionPicture picture{domain.feature_names(), atlas.prior_cone(), region, domain.weights().integer, {}};
  for (const auto& facet : region.facets()) picture.captions.push_back(described(domain, facet));
  const auto [svg, width, height] = region_svg(picture);
  return {"bec.svg", svg.file(width, height, "The behaviour equivalence class of the policy of " + domain.id())};
}

SvgFile coverage_picture(const Atlas& atlas, const GridMap& map, const BoardSvg& boards, MdpIndex m) {
  const auto& domain = atlas.domain();
  const auto path = atlas.trajectory(atlas.index({m, domain.initial_state(m)}));
  Sheet sheet{boards, fmt::format("How many ways people could expect from where the robot stands, {} of {}",
                                  world_text(domain, m), domain.id())};
  const auto largest = std::max<std::size_t>(2, atlas.tables().coverage().max);
  for (const auto& configuration : configurations_on(domain, map, m, path)) {
    auto board = boards.board(m, configuration, true);
    for_each_cell_from_bottom(map, [&](const Cell& cell) {
      const auto state = map.find_state(m, with_robot_at(configuration, cell));
      if (!state || domain.mdp(m).is_terminal(*state)) return;
      const auto n = atlas.tables().coverage_set(atlas.index({m, *state})).size();
      boards.number(board, cell, n, static_cast<double>(n - 1) / static_cast<double>(largest - 1));
    });
    sheet.add(std::move(board), configuration_in_words(map, m, configuration));
  }
  return {"coverage.svg", sheet.file()};
}

// What is written below a path.
std::string path_caption(const Domain& domain, MdpIndex m, const std::string& text, const Trajectory& path) {
  return text + (path.repeats_from ? ". And so on: " + never_in_words(domain, m, path) : "");
}

// The ways that most people expect, where not all are known.
SvgFile likely_picture(const Atlas& atlas, const GridMap& map, const BoardSvg& boards, MdpIndex m) {
  constexpr std::size_t kMost = 11;
  const auto& domain = atlas.domain();
  const auto start_index = atlas.index({m, domain.initial_state(m)});
  const auto start = map.state(m, domain.initial_state(m));
  const auto& robot = atlas.feature_counts(start_index);

  Sheet sheet{boards,
              fmt::format("What people could expect from the start of {} of {}", world_text(domain, m), domain.id())};
  const auto add = [&](const Trajectory& path, const std::string& text, bool is_own) {
    auto board = boards.board(m, start);
    board.add(0, 0, boards.path(m, path, is_own ? "#0b5cad" : "#b8480a", !is_own));
    sheet.add(std::move(board), path_caption(domain, m, text, path));
  };

  add(atlas.trajectory(start_index), "the robot's own: " + counts_text(domain, robot), true);
  Behaviours behaviours{atlas};
  std::size_t shown = 0;
  for (const auto& way : expected_ways(behaviours, start_index)) {
    const auto path = behaviours.trajectory(start_index, way.weights);
    if (way.counts == robot || !path || ++shown > kMost) continue;
    const auto told = preference_of_robot(domain, robot - way.counts);
    const auto sentence = told ? in_words(domain, *told) : std::string{};
    add(*path,
        fmt::format("{:.0f} % of people: {}{}", 100.0 * way.share, counts_text(domain, way.counts),
                    sentence.empty() ? "" : ": the robot's shows that " + sentence),
        false);
  }
  return {"counterfactuals.svg", sheet.file()};
}

SvgFile expected_picture(const Atlas& atlas, const GridMap& map, const BoardSvg& boards, MdpIndex m) {
  const auto& domain = atlas.domain();
  const auto start_index = atlas.index({m, domain.initial_state(m)});
  const auto start = map.state(m, domain.initial_state(m));
  Sheet sheet{boards,
              fmt::format("What people could expect from the start of {} of {}", world_text(domain, m), domain.id())};
  const auto& robot = atlas.feature_counts(start_index);
  auto own = boards.board(m, start);
  own.add(0, 0, boards.path(m, atlas.trajectory(start_index), "#0b5cad"));
  sheet.add(std::move(own), "the robot's own: " + counts_text(domain, robot));
  for (const auto& vertex : atlas.tables().coverage_set(start_index)) {
    if (vertex == robot) continue;
    const auto contrast = contrast_with(atlas, start_index, 0, vertex);
    auto board = boards.board(m, start);
    board.add(0, 0, boards.path(m, contrast.alternative, "#b8480a", true));
    sheet.add(std::move(board),
              counts_text(domain, vertex) + ": the robot's shows that " + in_words(domain, HalfSpace{robot - vertex}));
  }
  return {"counterfactuals.svg", sheet.file()};
}

}  // namespace

std::vector<SvgFile> domain_pictures(const Domain& domain, MdpIndex m) {
  const auto map = domain.drawing();
  if (!map) return {};
  const BoardSvg boards{*map};
  std::vector<SvgFile> files{map_picture(domain, *map, boards, m)};
  if (auto policy = policy_picture(domain, *map, boards, m)) files.push_back(*std::move(policy));
  return files;
}

std::vector<SvgFile> atlas_pictures(const Atlas& atlas, MdpIndex m) {
  const auto map = atlas.domain().drawing();
  if (!map) return {region_picture(atlas)};
  const BoardSvg boards{*map};
  if (!atlas.find_tables()) return {region_picture(atlas), likely_picture(atlas, *map, boards, m)};
  return {region_picture(atlas), coverage_picture(atlas, *map, boards, m), expected_picture(atlas, *map, boards, m)};
}

void write_pictures(const std::filesystem::path& folder, const std::vector<SvgFile>& files) {
  FileSet set{folder};
  for (const auto& file : files) set.write(file.name, file.text);
  set.commit();
}

}  // namespace kith
