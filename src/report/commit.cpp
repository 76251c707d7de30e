#include "report/commit.hpp"

#include "report/commit_identity.hpp"

namespace slipfit {

std::string commit_of_program() {
  return kCommit;
}

}  // namespace slipfit
