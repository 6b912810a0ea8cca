setprecision(BigFloat, 40; base=10)
function main(h, delta, p, q)
    println("step,p,q")
    for n in 0:5000
        println(n, ",", p, ",", q)
        f, g = -q - delta * q^3, -1 - 3delta * q^2
        p, q = p + h * f + h^2 / 2 * g * p, q + h * p + h^2 / 2 * f
    end
end
main(big"0.001", big"1", big"0", big"1.5")
