#include "studies/study.hpp"

namespace acstudy {

std::string Series::label() const {
  return scheme_label(scheme, cases.front().scene->standing()) + ", " + path +
         (stepping.empty() ? "" : ", " + stepping);
}

}  // namespace acstudy
