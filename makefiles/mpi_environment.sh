# Sourced: lets Open MPI run as root, and with more ranks than cores, without a word.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_btl_base_warn_component_unused=0
# One machine: no look for networks that others would use (0.4 s -> 0.2 s a start).
export OMPI_MCA_pml=ob1
# A run that ends with a code: no wait of a second or two for ranks that have ended.
export OMPI_MCA_odls_base_sigkill_timeout=0
export HWLOC_HIDE_ERRORS=2
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
