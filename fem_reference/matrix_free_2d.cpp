#include "fem_reference/matrix_free_impl.hpp"

namespace concord::fem {

template std::unique_ptr<InternalForce> make_matrix_free<2>(const Discretisation<2>&,
                                                            const Hyperelastic<2>&, double);
template void lumped_mass<2>(const Discretisation<2>&, double, double, dealii::Vector<double>&);

}  // namespace concord::fem
