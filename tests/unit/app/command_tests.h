#pragma once
// What the tests of commands begin with.
#include <catch2/catch.hpp>

#include "floe/scene/formulation.h"
#include "printed.h"

using namespace floe;
using Catch::Matchers::Contains;
using scene::Formulation;
using testing::columns_of;
using testing::contents;
using testing::OwnFolder;
using testing::printed;
