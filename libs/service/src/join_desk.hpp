#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "kith/service/live_service.hpp"
#include "strands.hpp"

namespace kith {

class HostedRoom;
struct ServiceState;
using HttpAnswer = LiveService::HttpAnswer;

// How people come in. On the strand of the desk.
class JoinDesk {
 public:
  explicit JoinDesk(ServiceState& service) : service_{service} {}

  // POST /api/join: a link, a question, or the page of a study that is full.
  void join(const LiveService::HttpRequest& request, const HttpAnswer& answer);

 private:
  // Somebody who comes in.
  struct Visit;
  using VisitPtr = std::shared_ptr<Visit>;

  [[nodiscard]] std::optional<LiveService::HttpReply> refusal_for(const Visit& visit);
  template <typename Step>
  void guarded(const VisitPtr& visit, const Step& step);
  void find_seat(const VisitPtr& visit);
  void try_next(const VisitPtr& visit);
  void take_seat(const VisitPtr& visit, const std::shared_ptr<HostedRoom>& room);
  void make_room(const VisitPtr& visit);
  void give_link(const VisitPtr& visit, const std::pair<std::int64_t, std::int64_t>& place, bool is_new);
  void turn_away(const VisitPtr& visit);
  void finish(const VisitPtr& visit, const LiveService::HttpReply& reply);
  void end_turn(Visit& visit);

  ServiceState& service_;
  Turns turns_;  // one looks for a seat at a time: people who come at the same moment share rooms
  std::map<std::string, std::deque<std::int64_t>> joins_;        // by address, when
  std::map<std::string, std::deque<std::int64_t>> wrong_codes_;  // the same of codes that do not exist
};

}  // namespace kith
