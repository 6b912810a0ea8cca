"""What a kernel computes in n degrees of freedom; loop, number systems and runs are the plane's."""
