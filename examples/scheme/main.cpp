#include "renormalized_upwind.hpp"
