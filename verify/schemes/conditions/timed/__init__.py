"""Order conditions with time: splittings and Runge–Kutta methods with their clocks."""
