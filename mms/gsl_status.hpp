#pragma once

/// @file
/// To be included where the status of a GSL call is looked at.

#include <gsl/gsl_errno.h>

namespace acstudy {

/// GSL would end the program at an error. Before main, since the handler is that of the whole process, threads
/// included.
inline const bool gsl_returns_its_status = (gsl_set_error_handler_off(), true);

}  // namespace acstudy
