#include "picture.hpp"

#include <algorithm>

namespace kith::cli {
namespace {

char arrow_of(const std::string& action) {
  if (action == "up") return '^';
  if (action == "down") return 'v';
  if (action == "left") return '<';
  if (action == "right") return '>';
  return action.front();
}

char& at(Picture& picture, const Cell& cell) {
  return picture[picture.size() - static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x - 1)];
}

// The same configuration with the robot at another cell; what is carried comes along.
GridState moved(GridState state, const Cell& cell) {
  state.robot = cell;
  for (std::size_t i = 0; i < state.items.size(); ++i) {
    if (state.carried[i]) state.items[i] = cell;
  }
  return state;
}

}  // namespace

Picture start_picture(const Domain& domain, DemoId id) { return domain.draw(id.mdp, id.start); }

Picture path_picture(const Domain& domain, DemoId id, const Trajectory& path) {
  auto picture = start_picture(domain, id);
  at(picture, domain.state(id.mdp, path.states.back()).robot) = 'o';
  for (std::size_t i = 0; i < path.actions.size(); ++i) {
    const auto& here = domain.state(id.mdp, path.states[i]).robot;
    const auto& next = domain.state(id.mdp, path.states[i + 1]).robot;
    const bool ends_here = domain.state(id.mdp, path.states.back()).robot == here;
    if (here != next && !ends_here) at(picture, here) = arrow_of(domain.action_names()[path.actions[i].value()]);
  }
  return picture;
}

Picture policy_picture(const Atlas& atlas, MdpIndex m, const GridState& configuration) {
  const auto& domain = atlas.domain();
  auto picture = domain.draw(m, std::nullopt);
  for (int y = 1; y <= domain.height(); ++y) {
    for (int x = 1; x <= domain.width(); ++x) {
      const Cell cell{x, y};
      const auto state = domain.find_state(m, moved(configuration, cell));
      if (!state || domain.mdp(m).is_terminal(*state)) continue;
      const auto path = atlas.trajectory(atlas.index({m, *state}));
      at(picture, cell) = arrow_of(domain.action_names()[path.actions.front().value()]);
    }
  }
  return picture;
}

std::string beside(const std::vector<Picture>& pictures, std::size_t indent) {
  std::string text;
  for (std::size_t row = 0; row < pictures.front().size(); ++row) {
    std::string line(indent, ' ');
    for (std::size_t i = 0; i < pictures.size(); ++i) line += (i > 0 ? "    " : "") + pictures[i][row];
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace kith::cli
