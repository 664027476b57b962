import java.io.BufferedReader;
import java.io.File;
import java.io.InputStreamReader;
import java.io.PrintStream;
import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import java.util.Random;
import org.eclipse.emf.common.util.Diagnostic;
import org.eclipse.emf.common.util.URI;
import org.eclipse.emf.ecore.EPackage;
import org.eclipse.emf.ecore.EcorePackage;
import org.eclipse.emf.ecore.impl.EPackageRegistryImpl;
import org.eclipse.emf.ecore.resource.Resource;
import org.eclipse.emf.ecore.resource.ResourceSet;
import org.eclipse.emf.ecore.resource.impl.ResourceSetImpl;
import org.eclipse.emf.ecore.util.Diagnostician;
import org.eclipse.emf.ecore.util.EcoreUtil;
import org.eclipse.emf.ecore.xmi.impl.EcoreResourceFactoryImpl;
import org.eclipse.emf.ecore.xml.type.XMLTypePackage;

/**
 * Asks Eclipse EMF what it thinks of metamodels and models.
 *
 * <p>A question is a line of words, separated by tabs; the answer is some lines, the last of which is DONE. What EMF
 * complains of begins with FAULT.
 *
 * <ul>
 *   <li>{@code metamodels ECORE...}: from now on, these are registered, and judged.
 *   <li>{@code workspace NAME FOLDER}: what {@code platform:/resource/NAME/} means.
 *   <li>{@code describe}: every registered metamodel, feature by feature.
 *   <li>{@code itself}: Ecore and EMF's types of XML, in the same way.
 *   <li>{@code check MODEL}: the model is read, resolved and validated.
 *   <li>{@code dump MODEL}: every value in it.
 *   <li>{@code alone QUESTION}: what it would answer if it knew no metamodel.
 *   <li>{@code save MODEL OUT}: it is read and written again.
 *   <li>{@code equal MODEL OTHER}: whether EMF finds two models structurally equal.
 *   <li>{@code make SEED FOLDER FLAVOUR}: random models of all registered metamodels are written.
 * </ul>
 */
public final class Referee {
  private static final PrintStream OUT = new PrintStream(System.out, true, StandardCharsets.UTF_8);
  private final List<EPackage> packages = new ArrayList<>();
  private final List<String[]> workspace = new ArrayList<>();

  public static void main(String[] arguments) throws Exception {
    Referee referee = new Referee();
    BufferedReader questions = new BufferedReader(new InputStreamReader(System.in, StandardCharsets.UTF_8));
    for (String line = questions.readLine(); line != null; line = questions.readLine()) {
      try {
        referee.answer(line.split("\t"));
      } catch (Exception fault) {
        complain("referee", String.valueOf(fault));
        fault.printStackTrace();
      }
      OUT.println("DONE");
    }
  }

  private void answer(String[] words) throws Exception {
    switch (words[0]) {
      case "metamodels" -> register(words);
      case "alone" -> alone(words);
      case "workspace" -> workspace.add(new String[] {words[1], words[2]});
      case "itself" -> {
        Metamodels.describe(EcorePackage.eINSTANCE, OUT);
        Metamodels.describe(XMLTypePackage.eINSTANCE, OUT);
      }
      case "describe" -> packages.forEach(each -> Metamodels.describe(each, OUT));
      case "check" -> judge(resources(), words[1], true);
      case "dump" -> dump(words[1]);
      case "save" -> save(words[1], words[2]);
      case "equal" -> compare(words[1], words[2]);
      case "make" -> new Instances(packages, new Random(Long.parseLong(words[1])), this::resources)
          .write(new File(words[2]), words[3], OUT);
      default -> complain("referee", words[0] + ": no such question");
    }
  }

  private void alone(String[] words) throws Exception {
    List<EPackage> known = List.copyOf(packages);
    packages.clear();
    answer(Arrays.copyOfRange(words, 1, words.length));
    packages.addAll(known);
  }

  private void register(String[] words) {
    packages.clear();
    ResourceSet metamodels = resources();
    List<Resource> files = new ArrayList<>();
    for (int index = 1; index < words.length; index++) {
      files.add(open(metamodels, words[index]));
    }
    for (Resource file : files) {
      file.getContents().forEach(root -> gather((EPackage) root, metamodels));
    }
    files.forEach(file -> judge(file, true));
  }

  private void gather(EPackage found, ResourceSet metamodels) {
    packages.add(found);
    metamodels.getPackageRegistry().put(found.getNsURI(), found);
    found.getESubpackages().forEach(inner -> gather(inner, metamodels));
  }

  private ResourceSet resources() {
    ResourceSet resources = new ResourceSetImpl();
    resources.setPackageRegistry(new EPackageRegistryImpl(EPackage.Registry.INSTANCE));
    packages.forEach(each -> resources.getPackageRegistry().put(each.getNsURI(), each));
    var factories = resources.getResourceFactoryRegistry().getExtensionToFactoryMap();
    factories.put("ecore", new EcoreResourceFactoryImpl());
    factories.put("*", new Instances.Factory());
    for (String[] project : workspace) {
      URI folder = URI.createFileURI(new File(project[1]).getAbsolutePath() + "/");
      resources.getURIConverter().getURIMap().put(URI.createURI("platform:/resource/" + project[0] + "/"), folder);
    }
    return resources;
  }

  private static Resource open(ResourceSet resources, String file) {
    URI uri = URI.createFileURI(new File(file).getAbsolutePath());
    try {
      return resources.getResource(uri, true);
    } catch (RuntimeException fault) {
      Resource broken = resources.getResource(uri, false);
      if (broken == null || broken.getErrors().isEmpty()) {
        complain(new File(file).getName(), fault.getMessage());
      }
      return broken;
    }
  }

  private static Resource judge(ResourceSet resources, String file, boolean validate) {
    Resource resource = open(resources, file);
    judge(resource, validate);
    return resource;
  }

  private static void judge(Resource resource, boolean validate) {
    if (resource == null) {
      return;
    }
    String file = new File(resource.getURI().toFileString()).getName();
    EcoreUtil.resolveAll(resource);
    resource.getErrors().forEach(fault -> complain(file, fault.getLine() + ": " + fault.getMessage()));
    resource.getWarnings().forEach(fault -> complain(file, fault.getLine() + ": " + fault.getMessage()));
    EcoreUtil.UnresolvedProxyCrossReferencer.find(resource).keySet()
        .forEach(proxy -> complain(file, "unresolved " + EcoreUtil.getURI(proxy)));
    if (validate) {
      resource.getContents().forEach(root -> report(file, Diagnostician.INSTANCE.validate(root)));
    }
    OUT.println("JUDGED " + file);
  }

  private static void report(String file, Diagnostic diagnostic) {
    if (diagnostic.getSeverity() != Diagnostic.OK && diagnostic.getChildren().isEmpty()) {
      complain(file, diagnostic.getMessage());
    }
    diagnostic.getChildren().forEach(child -> report(file, child));
  }

  private static void complain(String file, String message) {
    OUT.println("FAULT " + file + ": " + String.valueOf(message).replace('\n', ' '));
  }

  private void dump(String file) {
    Resource model = judge(resources(), file, false);
    new Models(model, OUT).print();
  }

  private void save(String file, String out) throws Exception {
    Resource model = judge(resources(), file, true);
    if (model != null) {
      model.setURI(URI.createFileURI(new File(out).getAbsolutePath()));
      model.save(java.util.Map.of("ENCODING", "UTF-8"));
    }
  }

  private void compare(String file, String other) {
    Resource first = judge(resources(), file, false);
    Resource second = judge(resources(), other, false);
    boolean equal = new Equality().equals(first.getContents(), second.getContents());
    OUT.println(equal ? "EQUAL" : "DIFFERENT");
  }
}
