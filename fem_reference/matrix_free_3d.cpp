#include "fem_reference/matrix_free_impl.hpp"

namespace concord::fem {

template std::unique_ptr<InternalForce> make_matrix_free<3>(const Discretisation<3>&,
                                                            const Hyperelastic<3>&, double);
template void lumped_mass<3>(const Discretisation<3>&, double, double, dealii::Vector<double>&);

}  // namespace concord::fem
