#define FLOE_EIGEN_TEMPLATE template
#include <floe/math/compiled_eigen.h>
