// Handles the request lines of ctl_server.h. A request is answered at once, or it becomes an order and its answer
// becomes the line. Server thread.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ctl_session.h"
#include "remote/instance/instance.h"

namespace kadans {

struct OrderRequest;

class CtlRequests {
 public:
  CtlRequests(Instance& instance, InstancePort& port, const CtlCounts& counts);
  ~CtlRequests();
  CtlRequests(const CtlRequests&) = delete;
  CtlRequests& operator=(const CtlRequests&) = delete;

  // Returns the answering line; "" when the request became an order, whose number is session.order.
  std::string take(CtlSession& session, const std::string& line);
  // Returns the line for an answer that has come. `answer` is nullptr when the wait was given up.
  std::string answered(CtlSession& session, const Answer* answer);
  // True when the session only waits for a report of the behaviors.
  bool reports(const CtlSession& session) const;
  // The newest sample of the watched signals; "" when there is no newer one.
  std::string sample(CtlSession& session);
  // To be called when the session ends.
  void forget(const CtlSession& session);
  // Empties the port; to be called now and then.
  void upkeep();

 private:
  struct Seen {  // how often a fault was seen
    std::uint32_t count = 0;
    Fault last;
  };

  bool known_here(const OrderRequest& request) const;
  std::string at_once(CtlSession& session, const OrderRequest& request);
  std::string send(CtlSession& session, const OrderRequest& request);
  std::string status(const Answer* report);
  std::string watch(CtlSession& session, const OrderRequest& request);
  void watches_fast(const CtlSession& session, bool fast);
  std::string faults();
  std::string told(const CtlSession& session, const OrderRequest& request, const Answer& answer);
  std::string get(const std::string& name, const Answer& report);
  std::string save(const CtlSession& session, const std::string& preset, const Answer& answer);

  Instance& instance_;
  InstancePort& port_;
  const CtlCounts& counts_;
  std::map<std::uint64_t, OrderRequest> asked_;  // the pending request of each session
  std::vector<std::uint64_t> leaving_;           // clients whose consoles must be closed
  std::set<std::uint64_t> fast_;                 // sessions that watch faster than the usual row
  std::map<std::pair<FaultCode, std::uint16_t>, Seen> faults_;
};

}  // namespace kadans
