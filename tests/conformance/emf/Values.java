import java.math.BigDecimal;
import java.math.BigInteger;
import java.util.Date;
import java.util.List;
import java.util.Random;
import org.eclipse.emf.ecore.EDataType;
import org.eclipse.emf.ecore.EEnum;
import org.eclipse.emf.ecore.util.EcoreUtil;

/** Random values of data types, awkward ones often. */
final class Values {
  private static final String[] TEXTS = {
    "", "a", "plain words", "<&>\"'", " leading and trailing ", "line\nfeed", "tab\tand\rreturn", "]]>", "\n",
    "umlaut \u00e4\u00df", "euro \u20ac", "\ud83d\ude00", "\u0085\u2028", "true", "1.0", "#//@x.0", "&amp;", "%20", "\u00a0"
  };
  private static final double[] REALS = {
    0.0, -0.0, 1.0, -1.5, 1e7, 9999999.999, 1e-3, 9.99e-4, Double.MIN_VALUE, Double.MAX_VALUE, Double.MIN_NORMAL,
    Double.NaN, Double.POSITIVE_INFINITY, Double.NEGATIVE_INFINITY, 1.0 / 3, 2e23, 42.36928, 0.1 + 0.2
  };
  private final Random random;
  private int identifiers;

  Values(Random random) {
    this.random = random;
  }

  /** Returns a value, or null where there is none that a file could hold. */
  Object of(EDataType type, boolean identifies) {
    if (identifies) {
      return EcoreUtil.createFromString(type, numeric(type) ? "" + ++identifiers : "id." + ++identifiers);
    }
    if (type instanceof EEnum enumeration) {
      return enumeration.getELiterals().isEmpty() ? null : pick(enumeration.getELiterals()).getInstance();
    }
    String name = type.getInstanceClassName();
    return name == null ? foreign(type) : ofClass(type, name.replace("java.lang.", ""));
  }

  private Object ofClass(EDataType type, String name) {
    return switch (name) {
      case "String" -> type.getName().equals("EString") ? text() : foreign(type);
      case "boolean", "Boolean" -> random.nextBoolean();
      case "byte", "Byte" -> (byte) random.nextInt();
      case "short", "Short" -> (short) random.nextInt();
      case "int", "Integer" -> pick(List.of(0, 1, -1, Integer.MIN_VALUE, Integer.MAX_VALUE, random.nextInt()));
      case "long", "Long" -> pick(List.of(0L, Long.MIN_VALUE, Long.MAX_VALUE, random.nextLong()));
      case "float", "Float" -> random.nextBoolean() ? (float) real() : Float.intBitsToFloat(random.nextInt());
      case "double", "Double" -> real();
      case "char", "Character" -> (char) random.nextInt(1 << 16);
      case "java.math.BigInteger" -> new BigInteger(1 + random.nextInt(120), random).negate();
      case "java.math.BigDecimal" -> new BigDecimal(new BigInteger(60, random), random.nextInt(40) - lowest(type));
      case "java.util.Date" -> new Date(random.nextLong() % 4_000_000_000_000L);
      case "byte[]" -> bytes();
      default -> foreign(type);
    };
  }

  /** XML Schema has no power of ten. */
  private static int lowest(EDataType type) {
    return type.getName().equals("Decimal") ? 0 : 20;
  }

  private static boolean numeric(EDataType type) {
    Class<?> kind = type.getInstanceClass();
    return kind != null && (kind.isPrimitive() || Number.class.isAssignableFrom(kind));
  }

  private Object foreign(EDataType type) {
    String text = switch (type.getName()) {
      case "EJavaClass" -> "java.lang.String";
      case "EJavaObject" -> null;
      default -> "word";
    };
    try {
      return text == null ? null : EcoreUtil.createFromString(type, text);
    } catch (RuntimeException fault) {
      return null;
    }
  }

  private String text() {
    return random.nextInt(3) > 0 ? TEXTS[random.nextInt(TEXTS.length)] : TEXTS[random.nextInt(TEXTS.length)] + text();
  }

  private double real() {
    return switch (random.nextInt(3)) {
      case 0 -> REALS[random.nextInt(REALS.length)];
      case 1 -> Double.longBitsToDouble(random.nextLong());
      default -> random.nextGaussian() * 100;
    };
  }

  private byte[] bytes() {
    byte[] found = new byte[random.nextInt(5)];
    random.nextBytes(found);
    return found;
  }

  <T> T pick(List<T> choices) {
    return choices.get(random.nextInt(choices.size()));
  }
}
