// What the lines of ctl_server.h mean: each is answered at once, or becomes an order whose answer becomes the line.
// Server thread.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "kadans/remote/ctl_session.h"
#include "kadans/remote/instance.h"

namespace kadans {

struct OrderRequest;

class CtlRequests {
 public:
  CtlRequests(Instance& instance, InstancePort& port, const CtlCounts& counts);
  ~CtlRequests();
  CtlRequests(const CtlRequests&) = delete;
  CtlRequests& operator=(const CtlRequests&) = delete;

  // The line that answers; "" when session.order says what it waits for.
  std::string take(CtlSession& session, const std::string& line);
  // The answer has come, or, without one, will not come any more.
  std::string answered(CtlSession& session, const Answer* answer);
  // Whether it only waits to be told what plays.
  bool reports(const CtlSession& session) const;
  // The newest sample for who watches; "" when there is no newer one.
  std::string sample(CtlSession& session);
  // The session ends.
  void forget(const CtlSession& session);
  // Empties the port, once in a while.
  void upkeep();

 private:
  struct Seen {  // of one fault
    std::uint32_t count = 0;
    Fault last;
  };

  bool known_here(const OrderRequest& request) const;
  std::string at_once(CtlSession& session, const OrderRequest& request);
  std::string send(CtlSession& session, const OrderRequest& request);
  std::string status(const Answer* report);
  std::string watch(CtlSession& session, const OrderRequest& request);
  std::string faults();
  std::string told(const CtlSession& session, const OrderRequest& request, const Answer& answer);
  std::string get(const std::string& name, const Answer& report);
  std::string save(const CtlSession& session, const std::string& preset, const Answer& answer);

  Instance& instance_;
  InstancePort& port_;
  const CtlCounts& counts_;
  std::map<std::uint64_t, OrderRequest> asked_;  // by session
  std::vector<std::uint64_t> leaving_;           // whose consoles are to be closed
  std::map<std::pair<FaultCode, std::uint16_t>, Seen> faults_;
};

}  // namespace kadans
