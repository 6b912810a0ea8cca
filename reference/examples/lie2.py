h, delta = 0.001, 1.0
p, q, area = 0.0, 1.5, 1.0
print("step,p,q,delta_j,lambda")
for n in range(5001):
    f, g = -q - delta * q**3, -1 - 3 * delta * q**2
    a, b = 1 + h * h / 2 * g, h * g - 3 * delta * h * h * q * p
    c, d = h, 1 + h * h / 2 * g
    print(n, p, q, a * d - b * c - 1, area - 1, sep=",")
    area *= a * d - b * c
    p, q = p + h * f + h * h / 2 * g * p, q + h * p + h * h / 2 * f
