// Catch2 version 2 has no library with a main; this file is left out with version 3.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
