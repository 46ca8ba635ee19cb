"""What all tests of the vehicle share: small matrices, which threads of BLAS only slow down."""

import pytest
from threadpoolctl import threadpool_limits


@pytest.fixture(autouse=True, scope="session")
def one_blas_thread():
    """Hold BLAS to one thread: on a busy machine two of them wait for each other, up to a hundred times as long."""
    with threadpool_limits(limits=1, user_api="blas"):
        yield
