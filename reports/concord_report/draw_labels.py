"""Direct labels at the right ends of curves, pushed apart so that none covers another."""


def spread(wanted, gap, low, high):
    """Positions near `wanted`, in its order, at least `gap` apart and inside [low, high] where
    there is room: pools of touching labels are centred on their wants."""
    order = sorted(range(len(wanted)), key=lambda i: wanted[i])
    pools = []  # [first want - offset sum, count]
    for rank, i in enumerate(order):
        pools.append([wanted[i], 1])
        while len(pools) > 1 and _top(pools[-2], gap) > _bottom(pools[-1], gap):
            centre, count = pools.pop()
            other = pools[-1]
            other[0] = (other[0] * other[1] + centre * count) / (other[1] + count)
            other[1] += count
    out, position = [0.0] * len(wanted), 0
    for centre, count in pools:
        for k in range(count):
            out[order[position]] = centre + (k - (count - 1) / 2) * gap
            position += 1
    return _inside(out, order, gap, low, high)


def _top(pool, gap):
    return pool[0] + pool[1] * gap / 2


def _bottom(pool, gap):
    return pool[0] - pool[1] * gap / 2


def _inside(out, order, gap, low, high):
    limit = high
    for i in reversed(order):
        out[i] = min(out[i], limit)
        limit = out[i] - gap
    limit = low
    for i in order:
        out[i] = max(out[i], limit)
        limit = out[i] + gap
    return out
